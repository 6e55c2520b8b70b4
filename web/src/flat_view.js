// SPDX-License-Identifier: GPL-3.0-or-later
// Without WebGL: the surfaces seen from straight above, shaded, on a plain canvas. It answers the same questions
// as the 3D view (stage.js), so that sections and readings work alike.
import { color_table } from './color_maps.js';
import { Picker } from './pick.js';
import { box_of_all, swatch_of, visible_surfaces } from './state.js';

const light = [-0.45, 0.45, 0.77];

export class FlatView {
  constructor(scene_data, state, canvas) {
    Object.assign(this, { data: scene_data, state, canvas, drawn: [], pickers: new Map(), frames: 0 });
    const again = () => { this.picture = null; this.invalidate(); };
    state.on(['visible', 'scalar', 'range', 'map', 'reversed', 'exaggeration', 'drape', 'drape_share'], again);
    state.on(['section', 'box', 'theme'], () => this.invalidate());
  }

  resize() {
    this.size = [this.canvas.parentElement.clientWidth, this.canvas.parentElement.clientHeight];
    this.picture = null;
    this.invalidate();
  }
  frame() { this.invalidate(); }
  toward_viewer() { return [0, 0, 1]; }
  pixels_per_nm() { return this.scale; }

  invalidate() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.draw();
    });
  }

  #fit() {
    const shown = visible_surfaces(this.state, this.data);
    const { low, high } = box_of_all(shown.length ? shown : this.data.surfaces);
    const [width, height] = this.size;
    this.scale = Math.min((width - 170) / (high[0] - low[0]), (height - 140) / (high[1] - low[1]));
    this.middle = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
  }

  project(x, y) {
    return [this.size[0] / 2 + (x - this.middle[0]) * this.scale, this.size[1] / 2 - (y - this.middle[1]) * this.scale];
  }
  pick_level(px, py) {
    return [this.middle[0] + (px - this.size[0] / 2) / this.scale, this.middle[1] - (py - this.size[1] / 2) / this.scale];
  }
  pick(px, py) {
    const [x, y] = this.pick_level(px, py);
    let best = null;
    this.data.surfaces.forEach((surface, index) => {
      if (!this.state.visible[index]) return;
      if (!this.pickers.has(index)) this.pickers.set(index, new Picker(surface));
      const hit = this.pickers.get(index).hit([x - surface.middle[0], y - surface.middle[1], 0], [0, 0, -1]);
      const z = hit && surface.middle[2] - hit.t;
      if (hit && (!best || z > best.z)) best = { index, surface, hit, x, y, z };
    });
    return best;
  }

  draw() {
    if (!this.size || this.size[0] < 200) return;
    this.#fit();
    if (!this.picture) this.#paint();
    this.canvas.width = this.size[0];
    this.canvas.height = this.size[1];
    this.canvas.getContext('2d').drawImage(this.picture, 0, 0);
    ++this.frames;
    this.drawn.forEach((listener) => listener());
  }

  #paint() {
    const [width, height] = this.size.map(Math.round);
    const pixels = new ImageData(width, height);
    const depth = new Float32Array(width * height).fill(-Infinity);
    const table = color_table(this.state.map, this.state.reversed);
    this.data.surfaces.forEach((surface, index) => {
      if (this.state.visible[index]) this.#fill(surface, index, pixels, depth, table);
    });
    this.picture = document.createElement('canvas');
    this.picture.width = width;
    this.picture.height = height;
    this.picture.getContext('2d').putImageData(pixels, 0, 0);
  }

  #fill(surface, index, pixels, depth, table) {
    const { positions, corners, middle } = surface, { width, height } = pixels;
    const scalar = this.state.scalar && surface.scalars.find(({ name }) => name === this.state.scalar);
    const own = swatch_of(index).match(/\w\w/g).map((text) => parseInt(text, 16));
    const { low, high } = this.state.range ?? { low: 0, high: 1 };
    const k = this.state.exaggeration;
    const [left, top] = this.project(middle[0], middle[1]);
    for (let i = 0; i < corners.length; i += 3) {
      const p = [0, 1, 2].map((c) => 3 * corners[i + c]);
      const x = p.map((c) => left + positions[c] * this.scale), y = p.map((c) => top - positions[c + 1] * this.scale);
      const ux = positions[p[1]] - positions[p[0]], uy = positions[p[1] + 1] - positions[p[0] + 1], uz = (positions[p[1] + 2] - positions[p[0] + 2]) * k;
      const vx = positions[p[2]] - positions[p[0]], vy = positions[p[2] + 1] - positions[p[0] + 1], vz = (positions[p[2] + 2] - positions[p[0] + 2]) * k;
      const n = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
      if (n[2] <= 0) continue;
      const shade = 0.35 + 0.75 * Math.max(0, (n[0] * light[0] + n[1] * light[1] + n[2] * light[2]) / Math.hypot(...n));
      const area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
      if (area === 0) continue;
      for (let row = Math.max(0, Math.ceil(Math.min(...y))); row <= Math.min(height - 1, Math.max(...y)); ++row) {
        for (let column = Math.max(0, Math.ceil(Math.min(...x))); column <= Math.min(width - 1, Math.max(...x)); ++column) {
          const b = ((column - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (row - y[0])) / area;
          const c = ((x[1] - x[0]) * (row - y[0]) - (column - x[0]) * (y[1] - y[0])) / area;
          if (b < -1e-9 || c < -1e-9 || b + c > 1 + 1e-9) continue;
          const weights = [1 - b - c, b, c];
          const z = weights.reduce((sum, w, j) => sum + w * positions[p[j] + 2], middle[2]);
          const at = row * width + column;
          if (z <= depth[at]) continue;
          depth[at] = z;
          let color = own;
          if (scalar) {
            const value = weights.reduce((sum, w, j) => sum + (w ? w * scalar.values[corners[i + j]] : 0), scalar.offset);
            const t = high > low ? Math.min(1, Math.max(0, (value - low) / (high - low))) : 0.5;
            color = value === value ? table.subarray(4 * Math.round(255 * t)) : [158, 158, 158];
          }
          for (let channel = 0; channel < 3; ++channel) pixels.data[4 * at + channel] = color[channel] * shade;
          pixels.data[4 * at + 3] = 255;
        }
      }
    }
  }
}
