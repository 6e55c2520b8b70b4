// SPDX-License-Identifier: GPL-3.0-or-later
// The 3D view: camera, light and what stands in it. Parallel projection, so that one scale holds everywhere.
import { DataTexture, OrthographicCamera, Raycaster, RGBAFormat, Scene, Texture, Vector2, Vector3, WebGLRenderer,
         LinearFilter, LinearMipmapLinearFilter } from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { Picker } from './pick.js';
import { SurfaceView } from './surface_view.js';
import { color_table } from './color_maps.js';
import { box_of_all, swatch_of, visible_surfaces } from './state.js';
import { BoxLines } from './box_lines.js';

export class Stage {
  constructor(scene_data, state, canvas) {
    this.data = scene_data;
    this.state = state;
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true, powerPreference: 'high-performance' });
    this.renderer.debug.checkShaderErrors = false;   // asking waits for the graphics card
    const all = box_of_all(scene_data.surfaces);
    this.center = all.low.map((low, axis) => (low + all.high[axis]) / 2);
    this.scene = new Scene();
    this.scene.scale.z = state.exaggeration;
    this.table = new DataTexture(color_table('viridis'), 256, 1, RGBAFormat);
    this.table.magFilter = this.table.minFilter = LinearFilter;
    this.views = scene_data.surfaces.map((surface) => new SurfaceView(surface, this.center, this.table));
    this.views.forEach((view) => this.scene.add(view.object));
    this.pickers = new Map();
    this.textures = new Map();
    this.lines = new BoxLines();
    this.scene.add(this.lines.object);
    this.camera = new OrthographicCamera(-1, 1, 1, -1, 0, 1);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = !matchMedia('(prefers-reduced-motion: reduce)').matches;
    this.controls.dampingFactor = 0.15;
    this.controls.zoomToCursor = true;
    this.controls.minZoom = 0.1;
    this.controls.maxZoom = 2000;
    this.controls.addEventListener('change', () => this.invalidate());
    this.drawn = [];   // called after each picture
    this.waiting = false;
    this.frames = 0;
    this.restyle();
    state.on(['visible', 'scalar', 'range', 'drape', 'drape_share', 'opacity', 'wireframe', 'cut', 'section', 'box', 'map',
              'reversed', 'theme'], () => this.restyle());
    state.on(['exaggeration'], () => {
      // The middle of the view stays where it is on the specimen.
      const k = state.exaggeration / this.scene.scale.z;
      const shift = this.controls.target.z * (k - 1);
      this.controls.target.z += shift;
      this.camera.position.z += shift;
      this.scene.scale.z = state.exaggeration;
      this.invalidate();
    });
  }

  restyle() {
    const { state } = this;
    this.table.image.data.set(color_table(state.map, state.reversed));
    this.table.needsUpdate = true;
    if (state.cut && state.section) this.cut_side = this.#near_side(state.section);
    const styles = getComputedStyle(document.documentElement);
    this.views.forEach((view, i) => {
      view.object.visible = state.visible[i];
      if (!state.visible[i]) return;
      view.color_by(state.scalar, state.range, swatch_of(i));
      view.set_opacity(state.opacity[i]);
      view.set_wireframe(state.wireframe, styles.getPropertyValue('--text').trim());
      view.cut_at(state.cut ? state.section : null, this.cut_side);
      const image = state.drape && this.data.images[state.drape.image];
      view.lay(image && this.#texture(state.drape), image, state.drape_share);
    });
    this.lines.set_color(styles.getPropertyValue('--line-3d').trim());
    this.invalidate();
  }

  /** On which side of the section the viewer stands when it is cut. */
  #near_side({ a, b }) {
    const [x, y] = this.toward_viewer();
    return x * (b[1] - a[1]) - y * (b[0] - a[0]) >= 0 ? 1 : -1;
  }

  #texture({ image, channel }) {
    const key = `${image} ${channel}`;
    if (!this.textures.has(key)) {
      const texture = new Texture(this.data.images[image].channels[channel].picture);
      texture.minFilter = LinearMipmapLinearFilter;
      texture.anisotropy = Math.min(8, this.renderer.capabilities.getMaxAnisotropy());
      texture.needsUpdate = true;
      this.textures.set(key, texture);
    }
    return this.textures.get(key);
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (width === 0 || height === 0 || (this.size?.[0] === width && this.size[1] === height)) return;
    const half = (this.camera.top - this.camera.bottom) / 2;
    this.size = [width, height];
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    this.renderer.setSize(width, height, false);
    this.#frustum(half, width / height);
    this.invalidate();
  }

  #frustum(half_height, aspect) {
    this.camera.top = half_height;
    this.camera.bottom = -half_height;
    this.camera.right = half_height * aspect;
    this.camera.left = -this.camera.right;
    this.camera.updateProjectionMatrix();
  }

  /** Looks at all that is visible, from the front left above, or from straight above. */
  frame(from_above = false) {
    const shown = visible_surfaces(this.state, this.data);
    const { low, high } = box_of_all(shown.length ? shown : this.data.surfaces);
    const k = this.state.exaggeration;
    const half = [0, 1, 2].map((axis) => (high[axis] - low[axis]) / 2 * (axis === 2 ? k : 1));
    const middle = [0, 1, 2].map((axis) => (high[axis] + low[axis]) / 2 - this.center[axis]);
    const target = new Vector3(middle[0], middle[1], middle[2] * k);
    const radius = Math.hypot(...half) || 1;
    const toward = from_above ? new Vector3(0, -1e-4, 1) : new Vector3(-0.52, -0.83, 0.72);
    this.controls.target.copy(target);
    this.camera.position.copy(target).addScaledVector(toward.normalize(), 6 * radius);
    this.camera.near = 0.01 * radius;
    this.camera.far = 60 * radius;
    this.camera.zoom = 1;
    this.camera.lookAt(target);
    this.camera.updateMatrixWorld();
    const inverse = this.camera.matrixWorldInverse;
    let wide = 0, high_up = 0;
    for (let corner = 0; corner < 8; ++corner) {
      const p = new Vector3(...half.map((h, axis) => (corner >> axis & 1 ? h : -h))).add(target).applyMatrix4(inverse);
      wide = Math.max(wide, Math.abs(p.x));
      high_up = Math.max(high_up, Math.abs(p.y));
    }
    const [width, height] = this.size ?? [1, 1];
    const free_x = 1 - Math.min(0.28, 150 / width), free_y = 1 - Math.min(0.32, 150 / height);   // axes need room
    this.#frustum(Math.max(high_up / free_y, wide / free_x * height / width), width / height);
    this.controls.update();
    this.invalidate();
  }

  invalidate() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      const moving = this.controls.update();
      this.draw();
      if (moving) this.invalidate();
    });
  }

  draw() {
    if (!this.size) return;
    const shown = visible_surfaces(this.state, this.data);
    this.lines.object.visible = this.state.box && shown.length > 0;
    if (shown.length > 0) this.lines.update(box_of_all(shown), this.center, this.toward_viewer());
    this.renderer.render(this.scene, this.camera);
    ++this.frames;
    this.drawn.forEach((listener) => listener());
  }

  /** From the specimen to the viewer. */
  toward_viewer() {
    return this.camera.position.clone().sub(this.controls.target).normalize().toArray();
  }

  /** Pixels of the page that 1 nm in the plane of the view takes. */
  pixels_per_nm() {
    return this.camera.zoom * this.size[1] / (this.camera.top - this.camera.bottom);
  }

  /** Where a place in nm is on the view, in pixels. */
  project(x, y, z) {
    const p = new Vector3(x - this.center[0], y - this.center[1], (z - this.center[2]) * this.scene.scale.z);
    p.project(this.camera);
    return [(p.x + 1) / 2 * this.size[0], (1 - p.y) / 2 * this.size[1]];
  }

  /** The nearest visible place of a surface under a pixel: { surface, x, y, z, hit }, or null. */
  pick(px, py) {
    const [origin, direction] = this.#ray(px, py);
    let best = null;
    this.views.forEach((view, index) => {
      if (!this.state.visible[index]) return;
      const from = origin.map((value, axis) => value - view.offset[axis]);
      const hit = this.#picker(index).hit(from, direction, (t) => this.#is_kept(view.surface, from, direction, t));
      if (hit && (!best || hit.t < best.hit.t)) best = { index, surface: view.surface, hit };
    });
    if (!best) return null;
    const [x, y, z] = origin.map((value, axis) => value + best.hit.t * direction[axis] + this.center[axis]);
    return { ...best, x, y, z };
  }

  /** Where the pixel's ray meets the level z. */
  pick_level(px, py, z) {
    const [origin, direction] = this.#ray(px, py);
    const t = (z - this.center[2] - origin[2]) / direction[2];
    return Number.isFinite(t) ? [origin[0] + t * direction[0] + this.center[0], origin[1] + t * direction[1] + this.center[1]]
                              : null;
  }

  #is_kept(surface, from, direction, t) {
    const { cut, section } = this.state;
    if (!cut || !section) return true;
    const x = from[0] + t * direction[0] + surface.middle[0], y = from[1] + t * direction[1] + surface.middle[1];
    const dx = section.b[0] - section.a[0], dy = section.b[1] - section.a[1];
    return this.cut_side * ((x - section.a[0]) * dy - (y - section.a[1]) * dx) <= 0;
  }

  #picker(index) {
    if (!this.pickers.has(index)) this.pickers.set(index, new Picker(this.data.surfaces[index]));
    return this.pickers.get(index);
  }

  #ray(px, py) {
    const ray = new Raycaster();
    ray.setFromCamera(new Vector2(px / this.size[0] * 2 - 1, 1 - py / this.size[1] * 2), this.camera);
    const k = this.scene.scale.z;
    const { origin, direction } = ray.ray;
    return [[origin.x, origin.y, origin.z / k], [direction.x, direction.y, direction.z / k]];
  }
}
