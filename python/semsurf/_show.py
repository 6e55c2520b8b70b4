# SPDX-License-Identifier: GPL-3.0-or-later
"""How objects show themselves: a line, a small picture and a table, a plot."""
import html
import struct

ROWS_OF_RECORD = 12
PICTURE = 192   # pixels along the longer side


def _length(nm):
    for unit, size in (("mm", 1e6), ("um", 1e3)):
        if abs(nm) >= size:
            return f"{nm / size:.4g} {unit}"
    return f"{nm:.4g} nm"


def _grid(made):
    rows, columns = made.shape
    return f"{columns} x {rows} samples of {' x '.join(_length(p) for p in dict.fromkeys(made.pitch))}"


def text_of_heights(made):
    import numpy
    z = numpy.asarray(made.heights)[made.valid]
    span = f", heights {_length(z.min())} to {_length(z.max())}" if z.size else ""
    return f"<semsurf.HeightField: {_grid(made)}{span}>"


def text_of_tip(made):
    import numpy
    z = numpy.asarray(made.heights)
    return f"<semsurf.Tip: {_grid(made)}, down to {_length(z[numpy.isfinite(z)].min())}>"


def text_of_image(made):
    return f"<semsurf.Image: {_grid(made)}, channels {', '.join(made.channels)}>"


def text_of_mesh(made):
    return f"<semsurf.Mesh: {len(made.triangles)} triangles, {len(made.vertices)} vertices>"


def _png(values):
    """A grey PNG of an array whose row 0 is the lowest, stretched between percentiles."""
    import zlib

    import numpy
    step = max(1, -(-max(values.shape) // PICTURE))
    values = numpy.asarray(values, dtype=float)[::step, ::step][::-1]
    finite = values[numpy.isfinite(values)]
    low, high = numpy.percentile(finite, [0.5, 99.5]) if finite.size else (0, 1)
    grey = numpy.nan_to_num((values - low) / max(high - low, 1e-300), nan=0, posinf=1, neginf=0)
    grey = (255 * numpy.clip(grey, 0, 1)).astype(numpy.uint8)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    lines = b"".join(b"\0" + row.tobytes() for row in grey)
    head = struct.pack(">IIBBBBB", grey.shape[1], grey.shape[0], 8, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(lines)) + chunk(b"IEND", b"")


def _picture(values):
    import base64
    data = base64.b64encode(_png(values)).decode()
    return f'<img src="data:image/png;base64,{data}" style="image-rendering: pixelated; min-width: {PICTURE}px">'


def _table(rows):
    cells = "".join(f"<tr><th style='text-align: left'>{html.escape(str(key))}</th>"
                    f"<td style='text-align: left'>{html.escape(str(value))}</td></tr>" for key, value in rows)
    return f"<table>{cells}</table>"


def _card(made, text, picture=""):
    from ._results import _line
    rows = [(key, _line(value)) for key, value in made.found.items()]
    record = list(made.record.items())
    rows += record[:ROWS_OF_RECORD]
    if len(record) > ROWS_OF_RECORD:
        rows.append(("...", f"{len(record) - ROWS_OF_RECORD} more in record"))
    return f"<div>{picture}<p>{html.escape(text.strip('<>'))}</p>{_table(rows)}</div>"


def html_of_heights(made):
    import numpy
    return _card(made, text_of_heights(made), _picture(numpy.where(made.valid, made.heights, numpy.nan)))


def html_of_tip(made):
    return _card(made, text_of_tip(made), _picture(made.heights))


def html_of_image(made):
    return _card(made, text_of_image(made), _picture(made[made.channels[0]]))


def html_of_mesh(made):
    return _card(made, text_of_mesh(made))


def html_of_findings(found):
    from ._results import _line
    return _table((key, _line(value)) for key, value in found.items())


def _draw(values, made, axes, label, title, keywords):
    if axes is None:
        import matplotlib.pyplot
        axes = matplotlib.pyplot.subplots()[1]
    keywords = {"cmap": "gray", "origin": "lower", "extent": made.extent, **keywords}
    shown = axes.imshow(values, **keywords)
    axes.figure.colorbar(shown, ax=axes, label=label)
    axes.set(xlabel="x / nm", ylabel="y / nm", title=title)
    return axes


def plot_heights(made, axes=None, **keywords):
    import numpy
    values = numpy.where(made.valid, made.heights, numpy.nan)
    return _draw(values, made, axes, "height / nm", "", {"cmap": "viridis", **keywords})


def plot_image(made, channel=None, axes=None, **keywords):
    name = channel or made.channels[0]
    values = made[name]
    unit = made.units[name]
    return _draw(values, made, axes, "per primary" if unit == "1" else unit, name, keywords)


def plot_tip(made, axes=None, **keywords):
    """Its sections through the apex along x and y."""
    if axes is None:
        import matplotlib.pyplot
        axes = matplotlib.pyplot.subplots()[1]
    row, column = made.apex
    z = made.heights
    for values, middle, pitch, name in ((z[row], column, made.pitch[0], "x"), (z[:, column], row, made.pitch[1], "y")):
        axes.plot([(i - middle) * pitch for i in range(len(values))], values, label=f"along {name}", **keywords)
    axes.set(xlabel="from the apex / nm", ylabel="height / nm")
    axes.legend()
    return axes


def plot_mesh(made, axes=None, **keywords):
    if axes is None:
        import matplotlib.pyplot
        axes = matplotlib.pyplot.figure().add_subplot(projection="3d")
    x, y, z = made.vertices.T
    axes.plot_trisurf(x, y, z, triangles=made.triangles, **{"cmap": "viridis", **keywords})
    axes.set(xlabel="x / nm", ylabel="y / nm", zlabel="z / nm")
    return axes
