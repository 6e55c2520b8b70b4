// SPDX-License-Identifier: GPL-3.0-or-later
// Drawing the section's line on the view, moving its ends, and reading values under the pointer.
import { with_unit, number } from './format.js';
import { value_at } from './pick.js';

export class SectionTool {
  constructor(stage, overlay, state, view, readout) {
    Object.assign(this, { stage, overlay, state, view, readout });
    view.addEventListener('pointerdown', (event) => this.#down(event), { capture: true });
    view.addEventListener('pointermove', (event) => this.#move(event), { capture: true });
    for (const name of ['pointerup', 'pointercancel']) {
      view.addEventListener(name, (event) => this.#up(event), { capture: true });
    }
    // A finger leaves when it is lifted: what it read stays.
    view.addEventListener('pointerleave', (event) => event.pointerType === 'mouse' && this.#tell(null));
  }

  #place(event) {
    const box = this.view.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  #handle_at([px, py], reach) {
    if (!this.state.section || !this.overlay.handles) return -1;
    return this.overlay.handles.findIndex(([x, y]) => Math.hypot(x - px, y - py) < reach);
  }

  #down(event) {
    if (event.button !== 0 || !event.isPrimary) return;
    const at = this.#place(event);
    const end = this.#handle_at(at, event.pointerType === 'touch' ? 26 : 14);
    if (end >= 0) {
      this.drag = { end, z: this.state.section.z };
    } else if (this.state.tool === 'section') {
      const found = this.stage.pick(...at);
      if (!found) return;
      this.drag = { start: [found.x, found.y], z: found.z };
    } else {
      this.tap = at;
      return;
    }
    event.stopPropagation();
    event.preventDefault();
    this.view.setPointerCapture(event.pointerId);
  }

  #move(event) {
    const at = this.#place(event);
    if (!this.drag) {
      if (event.buttons === 0 || event.pointerType === 'mouse') this.#hover(at, event.buttons);
      return;
    }
    event.stopPropagation();
    const found = this.stage.pick(...at);
    const place = found ? [found.x, found.y] : this.stage.pick_level(...at, this.drag.z);
    if (!place) return;
    const { section } = this.state;
    if (this.drag.start) {
      if (Math.hypot(place[0] - this.drag.start[0], place[1] - this.drag.start[1]) * this.stage.pixels_per_nm() < 3) return;
      this.state.set({ section: { a: this.drag.start, b: place, z: this.drag.z } });
    } else {
      this.state.set({ section: { ...section, [this.drag.end ? 'b' : 'a']: place } });
    }
  }

  #up(event) {
    if (this.drag) {
      event.stopPropagation();
      // The drawn line stays; the next drag turns the view again.
      if (this.drag.start && this.state.section) this.state.set({ tool: 'orbit' });
      this.drag = null;
    } else if (this.tap && event.pointerType !== 'mouse') {
      const at = this.#place(event);
      if (Math.hypot(at[0] - this.tap[0], at[1] - this.tap[1]) < 8) this.#tell(this.stage.pick(...at));
    }
    this.tap = null;
  }

  #hover(at, buttons) {
    if (buttons) return;
    this.hovered = at;
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      const end = this.#handle_at(this.hovered, 14);
      this.view.style.cursor = end >= 0 ? 'move' : this.state.tool === 'section' ? 'crosshair' : '';
      this.#tell(this.stage.pick(...this.hovered));
    });
  }

  #tell(found) {
    this.readout.hidden = !found;
    if (!found) return;
    const { surface, x, y, z, hit } = found;
    const size = Math.max(...surface.box.high.slice(0, 2).map((value, axis) => value - surface.box.low[axis]));
    const deep = surface.box.high[2] - surface.box.low[2];
    const texts = [`x ${number(x, size / 5000)}`, `y ${number(y, size / 5000)}`, `z ${number(z, deep / 5000)} nm`];
    const scalar = surface.scalars.find((candidate) => candidate.name === this.state.scalar);
    if (scalar && scalar.name !== 'height') {
      const { low, high } = this.state.range;
      texts.push(with_unit(`${scalar.name} ${number(value_at(scalar, hit), (high - low) / 2000)}`, scalar.unit));
    }
    if (this.stage.data.surfaces.length > 1) texts.unshift(surface.name);
    this.readout.textContent = texts.join('   ');
  }
}
