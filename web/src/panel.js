// SPDX-License-Identifier: GPL-3.0-or-later
// The controls beside the view.
import { color_map_names, color_table } from './color_maps.js';
import { h, icon } from './dom.js';
import { length_unit, number } from './format.js';
import { swatch_of } from './state.js';

const section = (title, ...content) => h('section', {}, h('h2', {}, title), ...content);
const row = (label, ...content) => h('label', { class: 'row' }, h('span', {}, label), ...content);

function toggle(state, name, label, key) {
  const input = h('input', { type: 'checkbox', class: 'switch', checked: state[name],
                             onchange: () => state.set({ [name]: input.checked }) });
  state.on([name], () => { input.checked = state[name]; });
  return h('label', { class: 'row', title: key ? `Key ${key}` : null }, h('span', {}, label), input);
}

function surfaces_section(scene, state, actions) {
  const list = h('ul', { class: 'surfaces' });
  scene.surfaces.forEach((surface, i) => {
    const name = h('button', { class: 'surface', 'data-surface': i, title: i < 9 ? `Show it alone (${i + 1})` : 'Show it alone',
                               onclick: () => actions.show_alone(i) },
      h('span', { class: 'swatch', style: `background:${swatch_of(i)}` }),
      h('span', { class: 'name' }, surface.name), i < 9 ? h('kbd', {}, String(i + 1)) : null);
    const eye = h('button', { class: 'plain', 'aria-label': `Show ${surface.name}`, title: 'Show or hide',
      onclick: () => state.set({ visible: state.visible.map((shown, k) => (k === i ? !shown : shown)) }) }, icon('eye'));
    const opacity = h('input', { type: 'range', min: '0.1', max: '1', step: '0.05', value: '1',
      'aria-label': `Opacity of ${surface.name}`, title: 'Opacity',
      oninput: () => state.set({ opacity: state.opacity.map((o, k) => (k === i ? Number(opacity.value) : o)) }) });
    const item = h('li', {}, name, opacity, eye);
    const follow = () => {
      item.classList.toggle('hidden-surface', !state.visible[i]);
      name.setAttribute('aria-pressed', String(state.visible[i]));
      eye.setAttribute('aria-pressed', String(state.visible[i]));
    };
    state.on(['visible'], follow);
    follow();
    list.append(item);
  });
  const all = scene.surfaces.length > 1
    ? h('button', { class: 'small', onclick: () => actions.show_all(), title: 'Key A' }, 'Show all') : null;
  return section(scene.surfaces.length > 1 ? 'Surfaces' : 'Surface', list, all);
}

function range_inputs(state, actions) {
  const input = (name) => {
    const field = h('input', { type: 'number', step: 'any', 'aria-label': name === 'low' ? 'Lowest colour' : 'Highest colour', id: name });
    field.addEventListener('change', () => {
      const value = Number(field.value) * scale();
      if (field.value !== '' && Number.isFinite(value)) state.set({ range: { ...state.range, [name]: value } });
      else follow();
    });
    return field;
  };
  const unit_of = () => (state.range && state.unit === 'nm'
    ? length_unit(Math.max(Math.abs(state.range.low), Math.abs(state.range.high))) : [state.unit === '1' ? '' : state.unit, 1]);
  const scale = () => unit_of()[1];
  const low = input('low'), high = input('high'), unit = h('span', { class: 'unit' });
  const follow = () => {
    if (!state.range) return;
    const resolution = (state.range.high - state.range.low) / scale() / 1000;
    low.value = number(state.range.low / scale(), resolution).replace('−', '-');
    high.value = number(state.range.high / scale(), resolution).replace('−', '-');
    unit.textContent = unit_of()[0];
  };
  state.on(['range'], follow);
  follow();
  return h('div', { class: 'range' }, low, h('span', {}, 'to'), high, unit,
    h('button', { class: 'small', title: 'From the values themselves (0.2 to 99.8 %)', onclick: () => actions.reset_range() }, 'Auto'));
}

function color_section(scene, state, actions) {
  const names = [...new Set(scene.surfaces.flatMap((surface) => surface.scalars.map(({ name }) => name)))];
  const by = h('select', { id: 'scalar', onchange: () => actions.color_by(by.value) },
    names.map((name) => h('option', { value: name }, name)), h('option', { value: '' }, 'each surface its own'));
  by.value = state.scalar;
  state.on(['scalar'], () => { by.value = state.scalar; });
  const strip = h('canvas', { width: 256, height: 1, class: 'strip', 'aria-hidden': 'true' });
  const map = h('select', { onchange: () => state.set({ map: map.value }) }, color_map_names.map((name) => h('option', { value: name }, name)));
  const follow = () => {
    map.value = state.map;
    strip.getContext('2d').putImageData(new ImageData(new Uint8ClampedArray(color_table(state.map, state.reversed)), 256, 1), 0, 0);
  };
  state.on(['map', 'reversed'], follow);
  follow();
  const parts = [row('Colour by', by), row('Map', map), strip, range_inputs(state, actions), toggle(state, 'reversed', 'Reversed')];
  const placed = scene.images.flatMap((image, i) => (image.pitch_nm ? image.channels.map((channel, c) => [i, c, `${image.name}: ${channel.name}`]) : []));
  if (placed.length) {
    const laid = h('select', { id: 'drape', onchange: () => {
      const [image, channel] = laid.value.split(' ').map(Number);
      state.set({ drape: laid.value === '' ? null : { image, channel } });
    } }, h('option', { value: '' }, 'no image'), placed.map(([i, c, text]) => h('option', { value: `${i} ${c}` }, text)));
    const share = h('input', { type: 'range', min: '0', max: '1', step: '0.05', 'aria-label': 'How much of the image shows',
      oninput: () => state.set({ drape_share: Number(share.value) }) });
    const follow_drape = () => {
      laid.value = state.drape ? `${state.drape.image} ${state.drape.channel}` : '';
      share.value = String(state.drape_share);
      share.disabled = !state.drape;
    };
    state.on(['drape', 'drape_share'], follow_drape);
    follow_drape();
    parts.push(row('Laid on', laid), row('Image shows', share));
  }
  return section('Colour', ...parts);
}

/** The slider moves evenly through factors from 0.1 to 1000. */
function exaggeration_row(state) {
  const slider = h('input', { type: 'range', min: '-1', max: '3', step: '0.01', 'aria-label': 'Heights times',
    oninput: () => {
      const factor = 10 ** Number(slider.value);
      state.set({ exaggeration: Math.abs(factor - 1) < 0.08 ? 1 : Number(factor.toPrecision(2)) });
    } });
  const text = h('input', { type: 'number', min: '0.01', step: 'any', 'aria-label': 'Heights times', id: 'exaggeration',
    onchange: () => {
      const factor = Number(text.value);
      if (factor > 0 && Number.isFinite(factor)) state.set({ exaggeration: factor });
      else follow();
    } });
  const follow = () => {
    slider.value = String(Math.log10(state.exaggeration));
    text.value = String(state.exaggeration);
  };
  state.on(['exaggeration'], follow);
  follow();
  return h('div', { class: 'row' }, h('span', {}, 'Heights ×'), slider, text,
    h('button', { class: 'small', onclick: () => state.set({ exaggeration: 1 }), title: 'To scale (E)' }, '1 : 1'));
}

export function make_panel(scene, state, actions, image_cards) {
  const parts = [];
  if (scene.surfaces.length) {
    parts.push(surfaces_section(scene, state, actions), color_section(scene, state, actions),
      section('View', exaggeration_row(state), toggle(state, 'box', 'Axes', 'G'), toggle(state, 'wireframe', 'Triangles', 'W'),
              toggle(state, 'cut', 'Cut away at the section', 'C')));
  }
  if (image_cards.length) parts.push(h('section', { class: 'images' }, h('h2', {}, image_cards.length > 1 ? 'Images' : 'Image'), ...image_cards));
  return h('aside', { id: 'panel', 'aria-label': 'Settings' }, ...parts);
}
