# SPDX-License-Identifier: GPL-3.0-or-later
"""What is found besides data."""


class Findings(dict):
    """A dictionary whose values are attributes, too: ``found["tilt_deg"]``, ``found.tilt_deg``."""

    def __getattr__(self, name):
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"there is no '{name}'; there are {', '.join(self)}") from None

    def __dir__(self):
        return [*super().__dir__(), *(key for key in self if isinstance(key, str) and key.isidentifier())]

    def __repr__(self):
        return "\n".join(f"{key}: {_line(value)}" for key, value in self.items()) or "Findings()"

    def _repr_html_(self):
        from ._show import html_of_findings
        return html_of_findings(self)


def _line(value):
    """One line, whatever it is."""
    if isinstance(value, Findings) and set(value) == {"value", "stderr"}:
        return f"{value.value:.6g} ± {value.stderr:.2g}"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {_line(one)}" for key, one in list(value.items())[:6]) + \
            (", ...}" if len(value) > 6 else "}")
    if hasattr(value, "shape") and hasattr(value, "dtype"):
        return f"array {' x '.join(map(str, value.shape))} of {value.dtype}"
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, list) and len(value) > 3:
        return f"{len(value)} of {_line(value[0])}"
    text = " ".join(str(value).split())
    return text if len(text) <= 100 else text[:97] + "..."
