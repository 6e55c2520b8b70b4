// SPDX-License-Identifier: GPL-3.0-or-later
// A surface as an object of three.js, in nm from `center`.
import { BufferAttribute, BufferGeometry, Color, Group, Mesh, MeshBasicMaterial } from 'three';
import { make_surface_material, unknown } from './surface_material.js';

/** Sums of the faces' normals at their corners, in true proportions. */
function normals_of(positions, corners) {
  const normals = new Float32Array(positions.length);
  for (let i = 0; i < corners.length; i += 3) {
    const a = 3 * corners[i], b = 3 * corners[i + 1], c = 3 * corners[i + 2];
    const ux = positions[b] - positions[a], uy = positions[b + 1] - positions[a + 1], uz = positions[b + 2] - positions[a + 2];
    const vx = positions[c] - positions[a], vy = positions[c + 1] - positions[a + 1], vz = positions[c + 2] - positions[a + 2];
    const nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    for (const corner of [a, b, c]) {
      normals[corner] += nx;
      normals[corner + 1] += ny;
      normals[corner + 2] += nz;
    }
  }
  for (let i = 0; i < normals.length; i += 3) {
    const length = Math.hypot(normals[i], normals[i + 1], normals[i + 2]);
    if (length > 0) for (let axis = 0; axis < 3; ++axis) normals[i + axis] /= length;
    else normals[i + 2] = 1;
  }
  return normals;
}

export class SurfaceView {
  constructor(surface, center, table) {
    this.surface = surface;
    this.offset = surface.middle.map((value, axis) => value - center[axis]);
    this.geometry = new BufferGeometry();
    this.geometry.setAttribute('position', new BufferAttribute(surface.positions, 3));
    this.geometry.setAttribute('normal', new BufferAttribute(normals_of(surface.positions, surface.corners), 3));
    this.geometry.setAttribute('scalar', new BufferAttribute(new Float32Array(surface.positions.length / 3), 1));
    this.geometry.setIndex(new BufferAttribute(surface.corners, 1));
    this.material = make_surface_material(table);
    this.object = new Group();
    this.object.position.set(...this.offset);
    this.object.add(new Mesh(this.geometry, this.material));
    this.shown = null;
  }

  /** Colours by that scalar, or by the surface's own colour where it has none of the name. */
  color_by(name, range, own_color) {
    const u = this.material.uniforms;
    const scalar = this.surface.scalars.find((candidate) => candidate.name === name);
    u.own.value = scalar ? 0 : 1;
    const color = new Color(own_color);
    color.convertLinearToSRGB();
    u.own_color.value.set(color.r, color.g, color.b);
    if (!scalar) return;
    if (this.shown !== scalar) {
      const attribute = this.geometry.getAttribute('scalar');
      for (let i = 0; i < scalar.values.length; ++i) {
        attribute.array[i] = scalar.values[i] === scalar.values[i] ? scalar.values[i] : unknown;
      }
      attribute.needsUpdate = true;
      this.shown = scalar;
    }
    u.range.value.set(range.low - scalar.offset, range.high - scalar.offset);
  }

  lay(texture, image, share) {
    const u = this.material.uniforms;
    u.drape_share.value = texture ? share : 0;
    if (!texture) return;
    u.drape.value = texture;
    const [middle_x, middle_y] = this.surface.middle;
    u.drape_place.value.set(
      image.origin_nm[0] - image.pitch_nm[0] / 2 - middle_x, image.origin_nm[1] - image.pitch_nm[1] / 2 - middle_y,
      1 / (image.size[0] * image.pitch_nm[0]), 1 / (image.size[1] * image.pitch_nm[1]));
  }

  /** Takes away what lies right (side 1) or left (-1) of the line from a to b; null: nothing. */
  cut_at(section, side) {
    if (!section) return this.material.uniforms.cut.value.set(0, 0, 0);
    const dx = section.b[0] - section.a[0], dy = section.b[1] - section.a[1], length = Math.hypot(dx, dy) || 1;
    const nx = side * dy / length, ny = -side * dx / length;
    const distance = (section.a[0] - this.surface.middle[0]) * nx + (section.a[1] - this.surface.middle[1]) * ny;
    this.material.uniforms.cut.value.set(nx, ny, distance);
  }

  set_opacity(opacity) {
    this.material.uniforms.opacity.value = opacity;
    this.material.transparent = opacity < 1;
  }

  set_wireframe(on, color) {
    if (on && !this.wires) {
      this.wires = new Mesh(this.geometry, new MeshBasicMaterial({ wireframe: true, transparent: true, opacity: 0.28 }));
      this.object.add(this.wires);
    }
    if (this.wires) {
      this.wires.visible = on;
      this.wires.material.color.set(color);
    }
  }
}
