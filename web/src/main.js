// SPDX-License-Identifier: GPL-3.0-or-later
// Puts the page together.
import { diverging, is_signed, value_range } from './color_maps.js';
import { make_about, make_help } from './dialogs.js';
import { h, icon, save } from './dom.js';
import { FlatView } from './flat_view.js';
import { make_images } from './images_panel.js';
import { Overlay } from './overlay.js';
import { make_panel } from './panel.js';
import { ProfileChart } from './profile_chart.js';
import { profiles_of } from './profiles.js';
import { read_scene } from './scene_data.js';
import { SectionTool } from './section_tool.js';
import { Stage } from './stage.js';
import { box_of_all, make_state, visible_surfaces } from './state.js';

/** Heights so much larger that low relief can be seen: 1, or 2, 5, 10 ... */
function first_exaggeration(surfaces) {
  const { low, high } = box_of_all(surfaces);
  const share = (high[2] - low[2]) / Math.max(high[0] - low[0], high[1] - low[1]);
  if (!(share > 0) || share > 0.08) return 1;
  const wanted = 0.16 / share, power = 10 ** Math.floor(Math.log10(wanted));
  return [1, 2, 5].map((lead) => lead * power).filter((factor) => factor <= wanted).pop() ?? 1;
}

function first_state(scene) {
  const surfaces = scene.surfaces;
  const several = surfaces.length > 1;
  const scalar = scene.scalar && surfaces.some((s) => s.scalars.some(({ name }) => name === scene.scalar)) ? scene.scalar : 'height';
  const drape = scene.drape && {
    image: scene.drape.image, channel: scene.images[scene.drape.image].channels.findIndex(({ name }) => name === scene.drape.channel),
  };
  return make_state({
    visible: surfaces.map((_, i) => !several || i === 0), before: null, scalar, range: null, unit: 'nm', map: 'viridis', reversed: false,
    drape: drape ?? null, drape_share: 1, opacity: surfaces.map(() => 1), wireframe: false, box: true, cut: false,
    exaggeration: surfaces.length ? first_exaggeration(surfaces) : 1, section: null, cursor: null, tool: 'orbit', theme: '',
  });
}

function make_actions(scene, state) {
  const actions = {
    /** The range and unit of a scalar over what is visible. */
    range_of(name) {
      const found = visible_surfaces(state, scene).flatMap((surface) => surface.scalars.filter((s) => s.name === name));
      const any = found.length ? found : scene.surfaces.flatMap((surface) => surface.scalars.filter((s) => s.name === name));
      const range = value_range(any);
      return { range: range && { low: range.low, high: range.high }, unit: any[0]?.unit ?? '' };
    },
    color_by(name) {
      if (name === '') return state.set({ scalar: '' });
      const { range, unit } = actions.range_of(name);
      const signed = name !== 'height' && range && is_signed(range);
      const reach = signed && Math.max(-range.low, range.high);
      const map = signed ? diverging : state.map === diverging ? 'viridis' : state.map;
      state.set({ scalar: name, unit, map, range: signed ? { low: -reach, high: reach } : range ?? { low: 0, high: 1 } });
    },
    reset_range() { actions.color_by(state.scalar); },
    show_alone(index) { actions.show(scene.surfaces.map((_, i) => i === index)); },
    show_all() { actions.show(scene.surfaces.map(() => true)); },
    show(visible) { state.set({ before: state.visible, visible }); },
    show_before() { if (state.before) actions.show(state.before); },
  };
  return actions;
}

function set_theme(state, theme) {
  document.documentElement.dataset.theme = theme;
  state.set({ theme });
}

function make_stage(scene, state, canvas, notice) {
  try {
    return new Stage(scene, state, canvas);
  } catch (error) {
    notice.hidden = false;
    notice.textContent = 'This browser shows no 3D (WebGL is off or missing): the surfaces are seen from above. Turn on ' +
      '“hardware acceleration” in its settings, or open the page in another browser, to turn them.';
    console.warn(error);
    // A canvas that was asked for WebGL cannot be painted on.
    const fresh = canvas.cloneNode();
    canvas.replaceWith(fresh);
    return new FlatView(scene, state, fresh);
  }
}

function save_picture(stage, overlay, scene) {
  stage.draw();
  const [width, height] = stage.size, ratio = stage.canvas.width / width;
  const canvas = h('canvas', { width: stage.canvas.width, height: stage.canvas.height });
  const pen = canvas.getContext('2d');
  pen.fillStyle = getComputedStyle(document.documentElement).getPropertyValue('--ground').trim();
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.drawImage(stage.canvas, 0, 0);
  pen.scale(ratio, ratio);
  overlay.paint(pen, width, height);
  canvas.toBlob((blob) => save(`${stem_of(scene)}.png`, blob));
}

const stem_of = (scene) => scene.title.replace(/[^\p{L}\p{N}._-]+/gu, '-').replace(/^-+|-+$/g, '') || 'page';

function start(scene) {
  const app = document.getElementById('app');
  const state = first_state(scene);
  const actions = make_actions(scene, state);
  if (scene.surfaces.length) {
    // The signed map is chosen for signed scalars here too.
    actions.color_by(state.scalar);
  }
  const about = make_about(scene), help = make_help(matchMedia('(pointer: coarse)').matches);
  const tool = (name, text, title, run) => h('button', { class: 'tool', id: `tool-${name}`, title, 'aria-label': title, onclick: run },
    icon(name), h('span', {}, text));
  const canvas = h('canvas', { class: 'picture', tabIndex: 0, 'aria-label': `Surfaces in 3D: ${scene.surfaces.map(({ name }) => name).join(', ')}` });
  const over = h('canvas', { class: 'over', 'aria-hidden': 'true' });
  const readout = h('output', { id: 'readout', hidden: true });
  const chip = h('button', { id: 'chip', title: 'Show heights to scale', onclick: () => state.set({ exaggeration: 1 }) });
  const hint = h('p', { id: 'hint', hidden: true }, 'Drag a line over the surface');
  const notice = h('p', { id: 'notice', role: 'alert', hidden: true });
  const view = h('main', { id: 'view' }, canvas, over, chip, hint, readout, notice);
  const dark = matchMedia('(prefers-color-scheme: dark)');
  let stage, overlay;
  const next_theme = () => set_theme(state, document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark');
  const section_button = tool('section', 'Section', 'Draw a section (S)', () => state.set({ tool: state.tool === 'section' ? 'orbit' : 'section' }));
  const in_3d = scene.surfaces.length ? [section_button, tool('top', 'Top', 'From above (T)', () => stage.frame(true)),
    tool('home', 'Reset', 'The first view (R)', () => stage.frame()),
    tool('camera', 'Picture', 'Save a picture (P)', () => save_picture(stage, overlay, scene))] : [];
  const head = h('header', {}, h('h1', { title: scene.title }, scene.title), h('span', { class: 'space' }), ...in_3d,
    tool('theme', '', 'Light or dark', next_theme), tool('keys', '', 'Help (?)', () => help.showModal()),
    tool('info', '', 'About this page', () => about.showModal()));
  const chart = new ProfileChart(scene, state, stem_of(scene));
  const cards = make_images(scene, state);
  app.replaceChildren(head, ...(scene.surfaces.length ? [view, chart.element] : []), make_panel(scene, state, actions, cards), about, help);
  app.classList.toggle('images-only', scene.surfaces.length === 0);
  document.documentElement.dataset.theme = dark.matches ? 'dark' : 'light';
  dark.addEventListener('change', () => set_theme(state, dark.matches ? 'dark' : 'light'));

  if (!scene.surfaces.length) return { scene, state };
  stage = make_stage(scene, state, canvas, notice);
  overlay = new Overlay(stage, state, over);
  let profiles = [];
  overlay.profiles = () => profiles;
  const measure = () => {
    profiles = profiles_of(scene, state);
    chart.show(profiles);
    stage.invalidate();
  };
  let asked = false;
  state.on(['section', 'visible'], () => {
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => { asked = false; measure(); });
  });
  state.on(['cursor'], () => stage.invalidate());
  new SectionTool(stage, overlay, state, view, readout);
  const follow = () => {
    chip.hidden = state.exaggeration === 1;
    chip.replaceChildren(`Heights × ${state.exaggeration}`, h('small', {}, 'show 1 : 1'));
    hint.hidden = state.tool !== 'section';
    section_button.setAttribute('aria-pressed', String(state.tool === 'section'));
    view.style.cursor = state.tool === 'section' ? 'crosshair' : '';
  };
  state.on(['exaggeration', 'tool'], follow);
  follow();
  listen_to_keys({ scene, state, actions, help, stage: () => stage, picture: () => save_picture(stage, overlay, scene) });
  new ResizeObserver(() => stage.resize()).observe(view);
  stage.resize();
  stage.frame();
  return { scene, state, stage, overlay, profiles: () => profiles, chart };
}

function listen_to_keys({ scene, state, actions, help, stage, picture }) {
  const first = state.exaggeration === 1 ? 10 : state.exaggeration;
  const flip = (name) => () => state.set({ [name]: !state[name] });
  const keys = {
    a: actions.show_all, b: actions.show_before, s: () => state.set({ tool: state.tool === 'section' ? 'orbit' : 'section' }),
    c: flip('cut'), w: flip('wireframe'), g: flip('box'), t: () => stage().frame(true), r: () => stage().frame(), p: picture,
    e: () => state.set({ exaggeration: state.exaggeration === 1 ? first : 1 }), '?': () => help.showModal(),
    d: () => state.drape && state.set({ drape_share: state.drape_share > 0 ? 0 : 1 }),
    escape: () => state.set(state.tool === 'section' ? { tool: 'orbit' } : { section: null, cursor: null, cut: false }),
  };
  addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || document.querySelector('dialog[open]')) return;
    if (/^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName) && event.target.type !== 'range') return;
    const index = Number(event.key) - 1;
    if (index >= 0 && index < scene.surfaces.length) actions.show_alone(index);
    else keys[event.key.toLowerCase()]?.();
  });
}

read_scene().then((scene) => {
  window.semsurf = start(scene);   // for scripts and tests
  requestAnimationFrame(() => requestAnimationFrame(() => { document.documentElement.dataset.ready = 'true';
    window.semsurf.ready_ms = performance.now(); }));
}).catch((error) => {
  console.error(error);
  document.getElementById('app').replaceChildren(h('p', { class: 'alone', role: 'alert' }, `The page cannot be shown: ${error.message}.`));
});
