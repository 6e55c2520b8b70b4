// SPDX-License-Identifier: GPL-3.0-or-later
// The section's profiles as a chart: a cursor that reads them, two marks whose difference is told.
import { h, save, svg } from './dom.js';
import { length_unit, number, ticks } from './format.js';
import { length_of, to_csv } from './profiles.js';
import { swatch_of } from './state.js';

const margin = { left: 62, right: 16, top: 12, bottom: 38 };

export class ProfileChart {
  constructor(scene, state, file_stem) {
    this.scene = scene;
    this.state = state;
    this.stem = file_stem;
    this.profiles = [];
    this.marks = [0.25, 0.75];   // shares of the length
    this.picture = svg('svg', { role: 'img', 'aria-label': 'Profile along the section' });
    this.readout = h('output', { class: 'readout', id: 'profile-readout', 'aria-live': 'polite' });
    this.differences = h('output', { class: 'readout', id: 'profile-differences' });
    this.element = h('section', { id: 'profile', hidden: true, 'aria-label': 'Profile' },
      h('div', { class: 'bar' }, h('h2', {}, 'Profile'), this.differences, h('span', { class: 'space' }),
        h('button', { class: 'small', id: 'csv', onclick: () => this.save_csv(), title: 'Save the numbers' }, 'CSV'),
        h('button', { class: 'small', onclick: () => this.save_svg(), title: 'Save the chart as drawing' }, 'SVG'),
        h('button', { class: 'small', onclick: () => this.save_png(), title: 'Save the chart as picture' }, 'PNG'),
        h('button', { class: 'small', onclick: () => state.set({ section: null, cursor: null, cut: false }),
                      title: 'Remove the section (Esc)' }, 'Remove')),
      this.picture, this.readout);
    new ResizeObserver(() => this.draw()).observe(this.picture);
    this.picture.addEventListener('pointermove', (event) => this.#move(event));
    this.picture.addEventListener('pointerdown', (event) => this.#grab(event));
    this.picture.addEventListener('pointerup', () => { this.held = null; });
    this.picture.addEventListener('pointerleave', () => this.held ?? state.set({ cursor: null }));
    state.on(['cursor'], () => this.#show_cursor());
    state.on(['theme'], () => this.draw());
    state.on(['tool', 'section'], () => this.#lay_out());
  }

  show(profiles) {
    this.profiles = profiles;
    this.#lay_out();
    this.draw();
  }

  /** There from when the tool is taken up, so that the view does not move under the line. */
  #lay_out() {
    this.element.hidden = !this.state.section && this.state.tool !== 'section';
    this.element.classList.toggle('empty', !this.state.section);
    if (!this.state.section) {
      this.picture.replaceChildren();
      this.differences.textContent = '';
      this.readout.textContent = 'Drag a line over the surface.';
    }
  }

  draw() {
    const { clientWidth: width, clientHeight: height } = this.picture;
    if (!this.state.section || width < 50 || height < 50) return;
    this.width = width;
    this.height = height;
    this.picture.setAttribute('viewBox', `0 0 ${width} ${height}`);
    const length = length_of(this.state.section) || 1;
    let low = Infinity, high = -Infinity;
    for (const { lines } of this.profiles) {
      for (const line of lines) for (const [, z] of line) {
        if (z < low) low = z;
        if (z > high) high = z;
      }
    }
    if (!(low <= high)) [low, high] = [0, 1];
    const room = (high - low) * 0.08 || 1;
    this.range = { s: [0, length], z: [low - room, high + room] };
    this.picture.replaceChildren(...this.#axes(), ...this.#lines(), ...this.#marks());
    this.cursor_line = svg('g', { class: 'cursor' });
    this.picture.append(this.cursor_line);
    this.#show_cursor();
    this.#show_differences();
  }

  x(s) { return margin.left + s / this.range.s[1] * (this.width - margin.left - margin.right); }
  y(z) {
    const [low, high] = this.range.z;
    return this.height - margin.bottom - (z - low) / (high - low) * (this.height - margin.top - margin.bottom);
  }
  s(x) {
    const share = (x - margin.left) / (this.width - margin.left - margin.right);
    return Math.min(1, Math.max(0, share)) * this.range.s[1];
  }

  #axes() {
    const { width, height } = this, parts = [];
    const [s_unit, s_size] = length_unit(this.range.s[1]);
    const [z_unit, z_size] = length_unit(this.range.z[1] - this.range.z[0]);
    const along = ticks(0, this.range.s[1] / s_size, (width - margin.left) / 90);
    const up = ticks(this.range.z[0] / z_size, this.range.z[1] / z_size, (height - margin.top - margin.bottom) / 36);
    for (const value of along) {
      const x = this.x(value * s_size);
      parts.push(svg('line', { class: 'grid', x1: x, x2: x, y1: margin.top, y2: height - margin.bottom }),
                 svg('text', { x, y: height - margin.bottom + 15, 'text-anchor': 'middle' }, number(value, along[1] - along[0])));
    }
    for (const value of up) {
      const y = this.y(value * z_size);
      parts.push(svg('line', { class: 'grid', x1: margin.left, x2: width - margin.right, y1: y, y2: y }),
                 svg('text', { x: margin.left - 7, y: y + 4, 'text-anchor': 'end' }, number(value, up[1] - up[0])));
    }
    parts.push(svg('text', { class: 'title', x: (margin.left + width - margin.right) / 2, y: height - 5, 'text-anchor': 'middle' },
                   `distance from A / ${s_unit}`),
               svg('text', { class: 'title', 'text-anchor': 'middle',
                             transform: `translate(14 ${(margin.top + height - margin.bottom) / 2}) rotate(-90)` },
                   `z / ${z_unit}`));
    return parts;
  }

  #lines() {
    return this.profiles.map(({ index, name, lines }) => svg('path', {
      d: lines.map((line) => line.map(([s, z], i) =>
        `${i ? 'L' : 'M'}${this.x(s).toFixed(2)} ${this.y(z).toFixed(2)}`).join('')).join(''),
      fill: 'none', stroke: swatch_of(index), 'stroke-width': 1.8, 'stroke-linejoin': 'round',
    }, svg('title', {}, name)));
  }

  #marks() {
    return this.marks.map((share, i) => {
      const x = this.x(share * this.range.s[1]);
      return svg('g', { class: 'mark', 'data-mark': i },
        svg('line', { x1: x, x2: x, y1: margin.top, y2: this.height - margin.bottom }),
        svg('rect', { x: x - 8, y: margin.top, width: 16, height: 16, rx: 4 }),
        svg('text', { x, y: margin.top + 12, 'text-anchor': 'middle' }, String(i + 1)));
    });
  }

  #at(event) {
    return event.clientX - this.picture.getBoundingClientRect().left;
  }

  #grab(event) {
    const x = this.#at(event);
    const distance = this.marks.map((share) => Math.abs(this.x(share * this.range.s[1]) - x));
    const nearest = distance[0] <= distance[1] ? 0 : 1;
    if (distance[nearest] < 14) {
      this.held = nearest;
      this.picture.setPointerCapture(event.pointerId);
    }
    this.#move(event);
  }

  #move(event) {
    if (!this.range) return;
    const s = this.s(this.#at(event));
    if (this.held !== null && this.held !== undefined) {
      this.marks[this.held] = s / this.range.s[1];
      this.draw();
    }
    this.state.set({ cursor: s });
  }

  #resolution() { return (this.range.z[1] - this.range.z[0]) / 2000; }

  #show_cursor() {
    if (!this.cursor_line) return;
    const s = this.state.cursor;
    if (s === null || s === undefined || !this.range) {
      this.cursor_line.replaceChildren();
      this.readout.textContent = 'Point at the chart to read it; drag 1 and 2 to measure.';
      return;
    }
    const x = this.x(s), parts = [svg('line', { x1: x, x2: x, y1: margin.top, y2: this.height - margin.bottom })];
    const texts = [`distance ${number(s, this.range.s[1] / 2000)} nm`];
    for (const profile of this.profiles) {
      const heights = profile.at(s);
      heights.forEach((z) => parts.push(svg('circle', { cx: x, cy: this.y(z), r: 3.5, fill: swatch_of(profile.index) })));
      if (heights.length) {
        texts.push(`${this.profiles.length > 1 ? `${profile.name} ` : ''}z ${
          heights.map((z) => number(z, this.#resolution())).join(', ')} nm`);
      }
    }
    this.cursor_line.replaceChildren(...parts);
    this.readout.textContent = texts.join('  ·  ');
  }

  #show_differences() {
    const [s1, s2] = this.marks.map((share) => share * this.range.s[1]);
    const texts = [`1 → 2: ${number(s2 - s1, this.range.s[1] / 2000)} nm along`];
    for (const profile of this.profiles) {
      const z1 = profile.at(s1)[0], z2 = profile.at(s2)[0];
      if (z1 === undefined || z2 === undefined) continue;
      const slope = Math.atan2(z2 - z1, Math.abs(s2 - s1)) * 180 / Math.PI;
      texts.push(`${this.profiles.length > 1 ? `${profile.name}: ` : ''}${number(z2 - z1, this.#resolution())} nm up` +
                 ` (${number(slope, 0.1)}°)`);
    }
    this.differences.textContent = texts.join('  ·  ');
  }

  save_csv() { save(`${this.stem}-profile.csv`, to_csv(this.profiles, this.state.section), 'text/csv'); }

  /** The chart alone, with its own styles and a key. */
  standalone() {
    const copy = this.picture.cloneNode(true);
    copy.querySelectorAll('.cursor').forEach((part) => part.remove());
    const extra = 18 * this.profiles.length;
    copy.setAttribute('xmlns', 'http://www.w3.org/2000/svg');
    copy.setAttribute('viewBox', `0 0 ${this.width} ${this.height + extra}`);
    copy.setAttribute('width', this.width);
    copy.setAttribute('height', this.height + extra);
    copy.prepend(svg('style', {}, 'text{font:12px sans-serif;fill:#333}.grid{stroke:#ddd}.mark line{stroke:#888;' +
      'stroke-dasharray:4 3}.mark rect{fill:#888}.mark text{fill:#fff;font-size:11px}'),
      svg('rect', { width: '100%', height: '100%', fill: '#fff' }));
    this.profiles.forEach(({ index, name }, i) => {
      const y = this.height + 18 * i + 4;
      copy.append(svg('line', { x1: margin.left, x2: margin.left + 22, y1: y, y2: y, stroke: swatch_of(index), 'stroke-width': 2.5 }),
                  svg('text', { x: margin.left + 30, y: y + 4 }, name));
    });
    return { text: new XMLSerializer().serializeToString(copy), width: this.width, height: this.height + extra };
  }

  save_svg() { save(`${this.stem}-profile.svg`, this.standalone().text, 'image/svg+xml'); }

  async save_png() {
    const { text, width, height } = this.standalone();
    const picture = new Image();
    picture.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(text)}`;
    await picture.decode();
    const canvas = h('canvas', { width: 2 * width, height: 2 * height });
    canvas.getContext('2d').drawImage(picture, 0, 0, 2 * width, 2 * height);
    canvas.toBlob((blob) => save(`${this.stem}-profile.png`, blob));
  }
}
