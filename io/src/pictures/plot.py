# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the plot that stands on standard input as JSON. Arguments: file, format (png or svg), and for tests a file
that tells what texts cover.

Exits with 3 if there is no Matplotlib. plot.cpp writes the JSON and has checked what is in it.
"""
import base64
import json
import sys

try:
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    import numpy as np
    from matplotlib import colors as mpl_colors
    from matplotlib import ticker
    from matplotlib.text import Text
except ImportError as error:
    print(error, file=sys.stderr)
    sys.exit(3)

# How wide a figure of one, two, three columns is: text is the larger the fewer there are.
WIDTH_INCH = [8.0, 11.0, 14.0]
INK = "#222222"
# Okabe and Ito, "Color universal design" (2008), in an order in which neighbours differ most.
COLORS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000", "#8a8a8a"]
MARKERS = ["o", "s", "^", "D", "v", "P", "X", "p"]
BAND = "#b8c4d0"
STYLE = {
    "font.family": "DejaVu Sans", "font.size": 10, "axes.titlesize": 11, "axes.labelsize": 10.5,
    "legend.fontsize": 9.5, "figure.titlesize": 13, "text.color": INK, "axes.edgecolor": "#666666",
    "axes.labelcolor": INK, "xtick.color": "#666666", "ytick.color": "#666666",
    "xtick.labelcolor": INK, "ytick.labelcolor": INK, "axes.linewidth": 0.8,
    "axes.spines.top": False, "axes.spines.right": False, "axes.axisbelow": True,
    "xtick.minor.visible": True, "ytick.minor.visible": True, "axes.unicode_minus": True,
    "xtick.major.size": 4.5, "ytick.major.size": 4.5, "xtick.minor.size": 2.5,
    "ytick.minor.size": 2.5, "axes.titleweight": "bold", "figure.titleweight": "bold",
    "axes.titlelocation": "left", "lines.solid_capstyle": "round", "path.simplify": True,
    # The same input gives the same bytes, and letters look the same everywhere.
    "svg.hashsalt": "semsurf", "svg.fonttype": "path",
}


def plain(text):
    """Text that Matplotlib does not take for a formula."""
    return text.replace("$", r"\$")


def draw_series(axes, series, number):
    color = COLORS[series["color"] if series["color"] is not None else number % len(COLORS)]
    marker = MARKERS[number % len(MARKERS)]
    dash = (0, (5, 2.5)) if series["dashed"] else "-"
    x, y, error, style = (series[key] for key in ("x", "y", "y_error", "style"))
    z = 3 + 0.01 * number
    if style in ("steps", "bars"):
        filled = style == "bars"
        # A histogram's floor is zero, which a logarithmic axis does not have.
        floor = 0 if axes.get_yscale() == "linear" else min(y) / 2 if filled else None
        handle = axes.stairs(y, x, baseline=floor, fill=filled, color=color, zorder=z - 0.5,
                             alpha=0.45 if filled else None, linewidth=1.8, linestyle=dash)
        if filled:
            axes.stairs(y, x, baseline=floor, color=color, linewidth=0.9, zorder=z - 0.4)
        x = [(a + b) / 2 for a, b in zip(x, x[1:])]
    elif style == "band":
        low, high = ([a + sign * b for a, b in zip(y, error)] for sign in (-1, 1))
        error = None
        handle = axes.fill_between(x, low, high, color=color, alpha=0.25, linewidth=0, zorder=z - 0.6)
    else:
        lined, pointed = style != "points", style != "line"
        z += 0.4 if pointed else 0   # lines under points
        handle, = axes.plot(x, y, color=color, linewidth=1.8, zorder=z,
                            linestyle=dash if lined else "none", marker=marker if pointed else "none",
                            markersize=6 if style == "points" else 5, markeredgecolor="white",
                            markeredgewidth=0.7)
    if error:
        axes.errorbar(x, y, yerr=error, fmt="none", ecolor=color, elinewidth=1.1, capsize=2.5,
                      capthick=1.1, alpha=0.8, zorder=z - 0.2)
    return handle


def values_of(image):
    flat = np.frombuffer(base64.b64decode(image["values"]), dtype="<f4").astype(float) + image["middle"]
    return flat.reshape(image["height"], image["width"])


def color_range(image, values):
    if image["range"]:
        return image["range"]
    finite = values[np.isfinite(values)]
    if not finite.size:
        return 0.0, 1.0
    low, high = np.percentile(finite, [0.5, 99.5])
    if image["colors"] == "difference":
        high = max(abs(low), abs(high))
        low = -high
    return (low, high) if high > low else (low - 0.5, high + 0.5)


def draw_image(axes, image):
    values = values_of(image)
    low, high = color_range(image, values)
    (dx, dy), (x, y) = image["pitch"], image["origin"]
    kind = image["colors"]
    name = {"grey": "gray", "heights": "cividis", "relief": "cividis", "difference": "RdBu_r"}[kind]
    norm = mpl_colors.Normalize(low, high)
    place = {"extent": (x - dx / 2, x + (values.shape[1] - 0.5) * dx, y - dy / 2, y + (values.shape[0] - 0.5) * dy),
             "origin": "lower", "interpolation": "nearest", "zorder": 1}
    mapped = plt.cm.ScalarMappable(norm, name)
    if kind == "relief":
        known = np.where(np.isfinite(values), values, low)
        light = mpl_colors.LightSource(azdeg=315, altdeg=45)
        lit = light.shade(known, plt.get_cmap(name), norm=norm, blend_mode="overlay", dx=dx, dy=-dy,
                          vert_exag=image["lit_per_unit"])
        lit[~np.isfinite(values)] = 1
        axes.imshow(lit, **place)
    else:
        axes.imshow(values, cmap=name, norm=norm, **place)
    axes.set_aspect("equal")
    # Beside the picture, not the cell, which a picture of another shape does not fill.
    bar = axes.figure.colorbar(mapped, cax=axes.inset_axes([1.02, 0, 0.03, 1]))
    bar.set_label(plain(image["label"]))
    bar.outline.set_linewidth(0.6)
    bar.ax.minorticks_off()


def draw_backdrop(axes, panel):
    """Bands and reference lines, with what they are called."""
    named = []
    for band in panel["bands"]:
        span = axes.axvspan if band["vertical"] else axes.axhspan
        handle = span(band["from"], band["to"], color=BAND, alpha=0.4, linewidth=0, zorder=0.5)
        named.append((handle, band["name"]))
    for line in panel["references"]:
        rule = axes.axvline if line["vertical"] else axes.axhline
        handle = rule(line["at"], color="#555555", linewidth=1.1, linestyle=(0, (2, 2)), zorder=2)
        named.append((handle, line["name"]))
    return named


def prepare_axis(axes, axis, settings, which, pictured):
    if settings["log"]:
        # Minor ticks over any number of decades; labels on some of them where there are few.
        axis.set_minor_locator(ticker.LogLocator(base=10, subs=tuple(range(2, 10)), numticks=99))
        axis.set_minor_formatter(ticker.LogFormatterSciNotation(minor_thresholds=(1, 0.4)))
    else:
        axis.set_minor_locator(ticker.AutoMinorLocator())
        axis.set_major_formatter(ticker.ScalarFormatter(useMathText=True))
        axis.get_major_formatter().set_powerlimits((-4, 5))
    if settings["range"]:
        (axes.set_xlim if which == "x" else axes.set_ylim)(*settings["range"])
    axis.set_label_text(plain(settings["label"]))
    if not pictured:
        axis.grid(True, which="major", color="#e4e4e4", linewidth=0.8)


def along(ends, step):
    """The ends of a line, a row each, and places between them, no farther apart than `step`."""
    places = [ends]
    for start, end in zip(ends, ends[1:]):
        length = np.hypot(*(end - start))
        if np.isfinite(length) and length > step:
            share = np.arange(1, int(length / step) + 1)[:, None] * step / length
            places.append(start + share * (end - start))
    return np.concatenate(places)


def occupied_on(axes, panel):
    """Places in pixels that texts should leave free, a row each: points, lines, error bars, references."""
    places = [np.empty((0, 2))]
    step = axes.figure.dpi * 3 / 72
    for series in panel["series"]:
        x, y = np.array(series["x"]), np.array(series["y"])
        if len(x) > len(y):
            x, y = np.repeat(x, 2)[1:-1], np.repeat(y, 2)
        elif series["y_error"]:
            for sign in (-1, 1):
                places.append(axes.transData.transform(np.stack([x, y + sign * np.array(series["y_error"])], axis=1)))
        ends = axes.transData.transform(np.stack([x, y], axis=1))
        places.append(ends if series["style"] == "points" else along(ends, step))
    for line in panel["references"]:
        at = [(line["at"], t) if line["vertical"] else (t, line["at"]) for t in (0, 1)]
        transform = axes.get_xaxis_transform() if line["vertical"] else axes.get_yaxis_transform()
        places.append(along(transform.transform(at), step))
    return np.concatenate(places)


def cost(box, places, boxes, room):
    """How much a text box would cover, or stick out."""
    covered = ((places >= box.min) & (places <= box.max)).all(axis=1).sum()
    overlapped = sum(box.overlaps(other) for other in boxes)
    outside = not (room.x0 <= box.x0 and box.x1 <= room.x1 and room.y0 <= box.y0 and box.y1 <= room.y1)
    return int(covered + 10 * overlapped + 40 * outside)


def clearance(axes):
    """Around a text, in pixels."""
    return axes.figure.dpi * 3 / 72


def box_of(note, renderer):
    """Of the words alone, without the line to their place."""
    note.update_positions(renderer)
    return Text.get_window_extent(note, renderer)


NEAR = 6   # points; a text farther from its place is joined to it by a line
REACHES = (NEAR, 12, 20, 32, 48, 68)


def sides_of(reach):
    ways = [(1, 1), (-1, 1), (1, -1), (-1, -1), (0, 1.3), (0, -1.3), (1.3, 0), (-1.3, 0)]
    if reach > NEAR:
        ways += [(2, 1), (-2, 1), (2, -1), (-2, -1), (1, 2), (-1, 2), (1, -2), (-1, -2)]
    return [(reach * h, reach * v) for h, v in ways]


def draw_notes(axes, panel, places, boxes, renderer):
    """Each beside its point, as near as it covers nothing. Returns texts and their boxes; `boxes` are taken."""
    texts, taken = [], list(boxes)
    room = axes.bbox.padded(-1)   # off the axes' lines
    for note in panel["notes"]:
        best = None
        for reach in REACHES:
            for h, v in sides_of(reach):
                joined = {"arrowstyle": "-", "color": "#777777", "linewidth": 0.7, "shrinkA": 1, "shrinkB": 4}
                text = axes.annotate(plain(note["text"]), (note["x"], note["y"]), (h, v),
                                     textcoords="offset points", fontsize=9, zorder=6,
                                     ha="left" if h > 0 else "right" if h < 0 else "center",
                                     va="bottom" if v > 0 else "top" if v < 0 else "center",
                                     arrowprops=joined if reach > NEAR else None)
                box = box_of(text, renderer)
                tried = (cost(box.padded(clearance(axes)), places, taken, room), text, box)
                if best and best[0] <= tried[0]:
                    text.remove()
                    continue
                if best:
                    best[1].remove()
                best = tried
                if best[0] == 0:
                    break
            if best[0] == 0:
                break
        texts.append(best[1])
        taken.append(best[2])
    return texts, taken[len(boxes):]


def make_legend(axes, named, **place):
    # Matplotlib leaves out names that begin with an underscore: set afterwards.
    legend = axes.legend([handle for handle, _ in named], ["x"] * len(named), framealpha=0.9,
                         edgecolor="#d0d0d0", borderaxespad=0.6, handlelength=2.2, **place)
    legend.set_zorder(7)
    for text, (_, name) in zip(legend.get_texts(), named):
        text.set_text(plain(name))
    return legend


LEGEND_PLACES = ("upper right", "upper left", "lower right", "lower left", "center right",
                 "center left", "upper center", "lower center")


def legend_inside(axes, named, places, boxes, renderer):
    """The legend where it covers least, and how much that is."""
    def try_at(place):
        legend = make_legend(axes, named, loc=place)
        box = legend.get_window_extent(renderer)
        return legend, cost(box.padded(clearance(axes)), places, boxes, axes.bbox.padded(1))

    tried = []
    for place in LEGEND_PLACES:
        legend, covers = try_at(place)
        tried.append((covers, place))
        if covers == 0:
            return legend, 0
    covers, place = min(tried, key=lambda one: one[0])
    return try_at(place)


def make_room_above(axes):
    scale = axes.yaxis.get_transform()
    low, high = scale.transform(axes.get_ylim())
    axes.set_ylim(*scale.inverted().transform([low, high + 0.12 * (high - low)]))


class PanelTexts:
    """Notes and legend of a panel."""

    def __init__(self, axes, panel, named):
        self.axes, self.panel = axes, panel
        self.named = [(handle, name) for handle, name in named if name] if panel["legend"] else []
        self.notes, self.boxes, self.legend = [], [], None
        self.beside = False

    def place(self, renderer):
        """Where the legend would cover something, the y axis grows if it may; else the legend goes beside the
        panel, which the layout then has to make room for. Returns whether the layout stays as it is."""
        attempts = 1 if self.panel["y"]["range"] else 5
        for attempt in range(attempts):
            places = self.put_notes([], renderer)
            if not self.named:
                return True
            self.legend, covers = legend_inside(self.axes, self.named, places, self.boxes, renderer)
            if covers == 0:
                return attempt == 0
            if attempt + 1 < attempts:
                make_room_above(self.axes)
        self.beside = True
        self.legend = make_legend(self.axes, self.named, loc="upper left", bbox_to_anchor=(1.0, 1.0))
        return False

    def place_again(self, renderer):
        """In a layout that has changed, and changes no more."""
        places = self.put_notes([], renderer)
        if self.legend and not self.beside:
            self.legend, _ = legend_inside(self.axes, self.named, places, self.boxes, renderer)

    def put_notes(self, boxes, renderer):
        for note in self.notes:
            note.remove()
        places = occupied_on(self.axes, self.panel)
        self.notes, self.boxes = draw_notes(self.axes, self.panel, places, boxes, renderer)
        return places

    def report(self, renderer):
        """What each text covers in the end, for tests: 0 is nothing."""
        places, out = occupied_on(self.axes, self.panel), []
        legend = [self.legend.get_window_extent(renderer)] if self.legend else []
        boxes = [box_of(note, renderer) for note in self.notes]
        for i, box in enumerate(boxes):
            others = boxes[:i] + boxes[i + 1:] + legend
            out.append({"text": self.panel["notes"][i]["text"], "covers": cost(box, places, others, self.axes.bbox)})
        for box in legend:
            room = box if self.beside else self.axes.bbox.padded(1)
            out.append({"text": "legend", "covers": cost(box, places, boxes, room)})
        return out


def draw(plot, path, kind, report=None):
    matplotlib.rcdefaults()
    matplotlib.rcParams.update(STYLE)
    rows, columns = plot["rows"], plot["columns"]
    inches = WIDTH_INCH[min(columns, len(WIDTH_INCH)) - 1]
    per_inch = plot["width_px"] / inches
    figure = plt.figure(figsize=(inches, plot["height_px"] / per_inch), dpi=per_inch,
                        layout="constrained")
    figure.get_layout_engine().set(w_pad=0.12, h_pad=0.12)
    if plot["title"]:
        figure.suptitle(plain(plot["title"]))
    panels = []
    for panel in plot["panels"]:
        axes = figure.add_subplot(rows, columns, tuple(panel["cells"]))
        axes.set_title(plain(panel["title"]))
        if panel["x"]["log"]:
            axes.set_xscale("log")
        if panel["y"]["log"]:
            axes.set_yscale("log", nonpositive="clip")
        if panel["image"]:
            draw_image(axes, panel["image"])
        named = [(draw_series(axes, series, n), series["name"])
                 for n, series in enumerate(panel["series"])]
        named += draw_backdrop(axes, panel)
        # Notes widen an axis as points do, and the limits stay once texts are placed.
        axes.update_datalim([(note["x"], note["y"]) for note in panel["notes"]])
        axes.autoscale_view()
        prepare_axis(axes, axes.xaxis, panel["x"], "x", panel["image"])
        prepare_axis(axes, axes.yaxis, panel["y"], "y", panel["image"])
        axes.set_xlim(axes.get_xlim())
        axes.set_ylim(axes.get_ylim())
        panels.append((axes, panel, named))
    figure.draw_without_rendering()   # settles the layout, in which texts are then placed
    renderer = figure.canvas.get_renderer()
    texts = [PanelTexts(axes, panel, named) for axes, panel, named in panels]
    settled = [one.place(renderer) for one in texts]
    if not all(settled):
        figure.draw_without_rendering()
    figure.set_layout_engine("none")   # laying out takes as long as drawing
    if not all(settled):
        for one in texts:
            one.place_again(renderer)
    if report:
        with open(report, "w", encoding="utf-8") as file:
            json.dump([line for one in texts for line in one.report(renderer)], file)
    # Nothing of the clock or the version in the file.
    metadata = {"Date": None, "Creator": "semsurf"} if kind == "svg" else {"Software": None}
    if plot["description"]:
        metadata["Description"] = plot["description"]
    figure.savefig(path, format=kind, metadata=metadata)


draw(json.load(sys.stdin), *sys.argv[1:4])
