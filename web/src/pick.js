// SPDX-License-Identifier: GPL-3.0-or-later
// Where a ray meets a surface first. Triangles are looked at in runs of neighbours whose box the ray meets.

const run = 128;   // triangles

export class Picker {
  constructor({ positions, corners }) {
    this.positions = positions;
    this.corners = corners;
    this.runs = Math.ceil(corners.length / 3 / run);
    this.boxes = new Float32Array(6 * this.runs);
    for (let r = 0; r < this.runs; ++r) {
      const box = [Infinity, Infinity, Infinity, -Infinity, -Infinity, -Infinity];
      for (let i = 3 * run * r; i < Math.min(corners.length, 3 * run * (r + 1)); ++i) {
        for (let axis = 0; axis < 3; ++axis) {
          const value = positions[3 * corners[i] + axis];
          if (value < box[axis]) box[axis] = value;
          if (value > box[3 + axis]) box[3 + axis] = value;
        }
      }
      this.boxes.set(box, 6 * r);
    }
  }

  /** { t, corners, weights } of the nearest hit of origin + t * direction, of any sign of t; or null. */
  hit(origin, direction, keep = () => true) {
    let best = null;
    for (let r = 0; r < this.runs; ++r) {
      if (!this.#meets(6 * r, origin, direction)) continue;
      const end = Math.min(this.corners.length, 3 * run * (r + 1));
      for (let i = 3 * run * r; i < end; i += 3) {
        const found = this.#triangle(i, origin, direction);
        if (found && (!best || found.t < best.t) && keep(found.t)) best = found;
      }
    }
    return best;
  }

  #meets(box, origin, direction) {
    let near = -Infinity, far = Infinity;
    for (let axis = 0; axis < 3; ++axis) {
      const low = this.boxes[box + axis] - origin[axis], high = this.boxes[box + 3 + axis] - origin[axis];
      const d = direction[axis];
      if (d === 0) {
        if (low > 0 || high < 0) return false;
        continue;
      }
      near = Math.max(near, Math.min(low / d, high / d));
      far = Math.min(far, Math.max(low / d, high / d));
    }
    return near <= far + 1e-6 * Math.abs(far);
  }

  // Moeller and Trumbore (1997); triangles count from both sides, their rims too.
  #triangle(i, origin, [dx, dy, dz]) {
    const p = this.positions;
    const a = 3 * this.corners[i], b = 3 * this.corners[i + 1], c = 3 * this.corners[i + 2];
    const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2];
    const vx = p[c] - p[a], vy = p[c + 1] - p[a + 1], vz = p[c + 2] - p[a + 2];
    const px = dy * vz - dz * vy, py = dz * vx - dx * vz, pz = dx * vy - dy * vx;
    const determinant = ux * px + uy * py + uz * pz;
    if (determinant === 0) return null;
    const sx = origin[0] - p[a], sy = origin[1] - p[a + 1], sz = origin[2] - p[a + 2];
    const u = (sx * px + sy * py + sz * pz) / determinant;
    if (u < -1e-6 || u > 1 + 1e-6) return null;
    const qx = sy * uz - sz * uy, qy = sz * ux - sx * uz, qz = sx * uy - sy * ux;
    const v = (dx * qx + dy * qy + dz * qz) / determinant;
    if (v < -1e-6 || u + v > 1 + 1e-6) return null;
    return { t: (vx * qx + vy * qy + vz * qz) / determinant, corners: [a / 3, b / 3, c / 3], weights: [1 - u - v, u, v] };
  }
}

/** A scalar at a hit, between the three corners. NaN where one of them has no value. */
export function value_at(scalar, hit) {
  let sum = scalar.offset;
  for (let k = 0; k < 3; ++k) if (hit.weights[k] !== 0) sum += hit.weights[k] * scalar.values[hit.corners[k]];
  return sum;
}
