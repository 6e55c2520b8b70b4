// SPDX-License-Identifier: GPL-3.0-or-later
// The box around the specimen: its floor and the two walls behind, with a grid at the ticks.
import { BufferAttribute, BufferGeometry, LineBasicMaterial, LineSegments } from 'three';
import { ticks } from './format.js';

export class BoxLines {
  constructor() {
    this.object = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ transparent: true, opacity: 0.55 }));
    this.object.frustumCulled = false;
    this.key = '';
  }

  set_color(color) { this.object.material.color.set(color); }

  update({ low, high }, center, toward_viewer) {
    const behind = toward_viewer.map((value, axis) => (value > 0 ? low[axis] : high[axis]));
    const key = [low, high, behind].join();
    if (key === this.key) return;
    this.key = key;
    const points = [];
    const line = (a, b) => points.push(...a.map((v, i) => v - center[i]), ...b.map((v, i) => v - center[i]));
    const at = (axis, value, other, other_value, third, third_value) => {
      const point = [0, 0, 0];
      point[axis] = value;
      point[other] = other_value;
      point[third] = third_value;
      return point;
    };
    for (let normal = 0; normal < 3; ++normal) {
      const u = (normal + 1) % 3, v = (normal + 2) % 3;
      for (const [along, across] of [[u, v], [v, u]]) {
        const about = across === 2 ? 4 : 6;
        for (const value of [low[across], ...ticks(low[across], high[across], about), high[across]]) {
          line(at(along, low[along], across, value, normal, behind[normal]),
               at(along, high[along], across, value, normal, behind[normal]));
        }
      }
    }
    this.object.geometry.dispose();
    this.object.geometry = new BufferGeometry();
    this.object.geometry.setAttribute('position', new BufferAttribute(new Float32Array(points), 3));
  }
}
