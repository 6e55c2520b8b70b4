// SPDX-License-Identifier: GPL-3.0-or-later
// What is written over the view: ticks of the box, scale bar, legend, the section's line and its ends.
import { color_table } from './color_maps.js';
import { length_unit, number, round_down, round_length, ticks } from './format.js';
import { box_of_all, swatch_of, visible_surfaces } from './state.js';

export class Overlay {
  constructor(stage, state, canvas) {
    this.stage = stage;
    this.state = state;
    this.canvas = canvas;
    this.profiles = () => [];
    stage.drawn.push(() => this.draw());
  }

  draw() {
    const [width, height] = this.stage.size;
    const ratio = Math.min(2, devicePixelRatio);
    if (this.canvas.width !== Math.round(width * ratio)) this.canvas.width = Math.round(width * ratio);
    if (this.canvas.height !== Math.round(height * ratio)) this.canvas.height = Math.round(height * ratio);
    const pen = this.canvas.getContext('2d');
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    this.paint(pen, width, height);
  }

  paint(pen, width, height) {
    const styles = getComputedStyle(document.documentElement);
    this.text = styles.getPropertyValue('--text').trim();
    this.quiet = styles.getPropertyValue('--quiet').trim();
    this.halo = styles.getPropertyValue('--halo').trim();
    pen.font = `12px ${styles.getPropertyValue('--font')}`;
    pen.lineJoin = 'round';
    const shown = visible_surfaces(this.state, this.stage.data);
    if (shown.length === 0) return;
    this.taken = [];
    if (this.state.box) this.#axes(pen, box_of_all(shown));
    this.#section(pen);
    this.#scale_bar(pen, width, height);
    this.#legend(pen, width, height);
  }

  #write(pen, text, x, y, align, color = this.text) {
    if (align === 'right') x = Math.max(x, pen.measureText(text).width + 6);   // nothing beyond the left edge
    pen.textAlign = align;
    pen.textBaseline = 'middle';
    pen.lineWidth = 3.5;
    pen.strokeStyle = this.halo;
    pen.strokeText(text, x, y);
    pen.fillStyle = color;
    pen.fillText(text, x, y);
  }

  /** Writes only where nothing else of the axes is written. */
  #write_apart(pen, text, x, y, align, color) {
    const width = pen.measureText(text).width + 6;
    const left = align === 'left' ? x - 3 : align === 'right' ? x - width + 3 : x - width / 2;
    if (this.taken.some(([l, t, w]) => left < l + w && l < left + width && Math.abs(y - t) < 15)) return;
    this.taken.push([left, y, width]);
    this.#write(pen, text, x, y, align, color);
  }

  #axes(pen, { low, high }) {
    const toward = this.stage.toward_viewer();
    const near = toward.map((value, axis) => (value > 0 ? high[axis] : low[axis]));
    const at = (axis, value, place) => place.map((other, i) => (i === axis ? value : other));
    const wide = Math.max(high[0] - low[0], high[1] - low[1]);
    // x and y along the floor's near edges; seen from below, along the ceiling's.
    const floor = toward[2] >= 0 ? low[2] : high[2];
    this.#axis(pen, 0, low, high, (value) => at(0, value, [0, near[1], floor]), length_unit(wide), 'x');
    this.#axis(pen, 1, low, high, (value) => at(1, value, [near[0], 0, floor]), length_unit(wide), 'y');
    // z along the edge that is farthest left.
    const edges = [[low[0], low[1]], [high[0], low[1]], [low[0], high[1]], [high[0], high[1]]];
    const left = edges.map((edge) => [this.stage.project(...edge, low[2])[0], edge]).sort((p, q) => p[0] - q[0])[0][1];
    this.#axis(pen, 2, low, high, (value) => [...left, value], length_unit(high[2] - low[2]), 'z');
  }

  #axis(pen, axis, low, high, place, [unit, size], name) {
    const from = this.stage.project(...place(low[axis])), to = this.stage.project(...place(high[axis]));
    const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
    if (length < 36 || !(high[axis] > low[axis])) return;
    // Away from the middle of the box, at right angles to the edge.
    const middle = this.stage.project(...low.map((value, i) => (value + high[i]) / 2));
    let out = [(to[1] - from[1]) / length, (from[0] - to[0]) / length];
    const half = [(from[0] + to[0]) / 2, (from[1] + to[1]) / 2];
    if ((half[0] - middle[0]) * out[0] + (half[1] - middle[1]) * out[1] < 0) out = [-out[0], -out[1]];
    const align = out[0] > 0.35 ? 'left' : out[0] < -0.35 ? 'right' : 'center';
    const room = axis === 2 ? 30 : 62;
    const values = ticks(low[axis] / size, high[axis] / size, Math.min(axis === 2 ? 5 : 7, Math.max(2, length / room)));
    const step = values.length > 1 ? values[1] - values[0] : high[axis] / size;
    let widest = 0;
    pen.strokeStyle = this.quiet;
    for (const value of values) {
      const [x, y] = this.stage.project(...place(value * size));
      const text = number(value, step);
      widest = Math.max(widest, pen.measureText(text).width);
      pen.lineWidth = 1;
      pen.strokeStyle = this.quiet;
      pen.beginPath();
      pen.moveTo(x, y);
      pen.lineTo(x + 5 * out[0], y + 5 * out[1]);
      pen.stroke();
      this.#write_apart(pen, text, x + 9 * out[0], y + 11 * out[1], align, this.quiet);
    }
    const away = align === 'center' ? 30 : 20 + widest + 6;
    const title = `${name} / ${unit}`;
    this.#write(pen, title, half[0] + away * out[0], half[1] + away * out[1] + (align === 'center' ? 0 : 2), align);
  }

  #section(pen) {
    const { section } = this.state;
    if (!section) return;
    const { a, b } = section, length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
    const place = ([s, z]) =>
      this.stage.project(a[0] + s / length * (b[0] - a[0]), a[1] + s / length * (b[1] - a[1]), z);
    const profiles = this.profiles();
    for (const { index, lines } of profiles) {
      for (const [color, line_width] of [[this.halo, 4.5], [profiles.length > 1 ? swatch_of(index) : this.text, 2]]) {
        pen.strokeStyle = color;
        pen.lineWidth = line_width;
        pen.beginPath();
        for (const line of lines) line.forEach((point, i) => (i ? pen.lineTo(...place(point)) : pen.moveTo(...place(point))));
        pen.stroke();
      }
    }
    this.handles = [this.#end(a, 0, profiles), this.#end(b, length, profiles)];
    this.handles.forEach(([x, y], i) => {
      pen.beginPath();
      pen.arc(x, y, 7, 0, 2 * Math.PI);
      pen.fillStyle = this.halo;
      pen.fill();
      pen.lineWidth = 2;
      pen.strokeStyle = this.text;
      pen.stroke();
      this.#write(pen, i ? 'B' : 'A', x, y - 17, 'center');
    });
    const s = this.state.cursor;
    if (s === null || s === undefined) return;
    for (const { index, heights } of profiles.map((p) => ({ ...p, heights: p.at(s) }))) {
      if (heights.length === 0) continue;
      pen.beginPath();
      pen.arc(...place([s, heights[0]]), 4, 0, 2 * Math.PI);
      pen.fillStyle = swatch_of(index);
      pen.fill();
      pen.lineWidth = 1.5;
      pen.strokeStyle = this.halo;
      pen.stroke();
    }
  }

  #end([x, y], s, profiles) {
    for (const profile of profiles) {
      const heights = profile.at(s);
      if (heights.length) return this.stage.project(x, y, heights[0]);
    }
    return this.stage.project(x, y, this.state.section.z);
  }

  #scale_bar(pen, width, height) {
    const per_nm = this.stage.pixels_per_nm();
    const length = round_down(Math.min(180, 0.3 * width) / per_nm);
    const x = 22, y = height - 26, end = x + length * per_nm;
    for (const [color, line_width] of [[this.halo, 6], [this.text, 3]]) {
      pen.strokeStyle = color;
      pen.lineWidth = line_width;
      pen.lineCap = 'butt';
      pen.beginPath();
      pen.moveTo(x, y);
      pen.lineTo(end, y);
      pen.stroke();
    }
    this.scale_bar = { nm: length, pixels: end - x };
    this.#write(pen, round_length(length), (x + end) / 2, y - 13, 'center');
  }

  #legend(pen, width, height) {
    const { state } = this;
    const laid = state.drape && state.drape_share === 1 && this.stage.data.images[state.drape.image].channels[state.drape.channel];
    if (!laid && (state.scalar === '' || !state.range)) return;
    const { low, high } = laid || state.range;
    const long = Math.min(220, 0.42 * height), x = width - 30, y = Math.max(70, 0.16 * height);
    const table = laid ? color_table('grey') : color_table(state.map, state.reversed);
    for (let i = 0; i < long; ++i) {
      const c = 4 * Math.round(255 * (1 - i / (long - 1)));
      pen.fillStyle = `rgb(${table[c]},${table[c + 1]},${table[c + 2]})`;
      pen.fillRect(x, y + i, 12, 1.5);
    }
    pen.lineWidth = 1;
    pen.strokeStyle = this.quiet;
    pen.strokeRect(x - 0.5, y - 0.5, 13, long + 1);
    const [unit, size] = (laid || state).unit === 'nm' ? length_unit(Math.max(Math.abs(low), Math.abs(high))) : [(laid || state).unit, 1];
    const values = ticks(low / size, high / size, long / 40);
    const step = values.length > 1 ? values[1] - values[0] : 1;
    for (const value of values) {
      const at = high > low ? y + long * (1 - (value * size - low) / (high - low)) : y + long / 2;
      pen.beginPath();
      pen.moveTo(x - 5, at);
      pen.lineTo(x - 1, at);
      pen.strokeStyle = this.quiet;
      pen.lineWidth = 1;
      pen.stroke();
      this.#write(pen, number(value, step), x - 8, at, 'right', this.quiet);
    }
    const name = laid ? `${laid.name} laid on` : state.scalar;
    const title = unit && unit !== '1' ? `${name} / ${unit}` : name;
    this.#write(pen, title, x + 12, y - 16, 'right');
  }
}
