// SPDX-License-Identifier: GPL-3.0-or-later
// About and help.
import { h, icon } from './dom.js';

function make_dialog(title, ...content) {
  const dialog = h('dialog', { 'aria-label': title },
    h('div', { class: 'bar' }, h('h2', {}, title), h('span', { class: 'space' }),
      h('button', { class: 'plain', title: 'Close', 'aria-label': 'Close', onclick: () => dialog.close() }, icon('close'))),
    h('div', { class: 'content' }, ...content));
  dialog.addEventListener('click', (event) => { if (event.target === dialog) dialog.close(); });
  return dialog;
}

const table = (values) => h('table', {}, Object.entries(values).map(([key, value]) =>
  h('tr', {}, h('th', { scope: 'row' }, key), h('td', {}, String(value)))));

const titled = (title, values) => (Object.keys(values).length
  ? [h('details', {}, h('summary', {}, title), table(values))] : []);

export function make_about(scene) {
  const parts = scene.surfaces.flatMap((surface) => [h('h3', {}, surface.name),
    table({ shape: surface.shape,
            ...Object.fromEntries(['x', 'y', 'z'].map((axis, i) =>
              [axis, `${+surface.box.low[i].toPrecision(7)} to ${+surface.box.high[i].toPrecision(7)} nm`])) }),
    ...titled('What its file says', surface.metadata)]);
  const images = scene.images.flatMap((image) => [h('h3', {}, image.name),
    table({ size: `${image.size[0]} × ${image.size[1]} pixels`,
            pixel: image.pitch_nm ? `${+image.pitch_nm[0].toPrecision(5)} × ${+image.pitch_nm[1].toPrecision(5)} nm` : 'not known',
            shown: 'in 256 greys between the 0.5 and 99.5 percentiles' }),
    ...titled('What its file says', image.metadata)]);
  return make_dialog('About this page',
    h('p', {}, 'All lengths are in nm: x to the right, y up the scan, z towards the microscope. Values between samples are ' +
      'those of the triangles shown. Nothing on this page is fetched from or sent to anywhere.'),
    ...parts, ...images, h('h3', {}, 'How it was made'), table(scene.metadata),
    h('p', { class: 'quiet' }, 'Written by semsurf, free software (GPL-3.0-or-later). Drawn with three.js, © its authors ' +
      '(MIT licence, in the source of this page). Colour maps: viridis, cividis, inferno of Matplotlib (CC0); blue–red of Moreland, 2009.'));
}

export function make_help(touch_first) {
  const keys = {
    '1 … 9': 'show that surface alone', 'A': 'show all surfaces', 'B': 'back to the surfaces shown before',
    'S': 'draw a section', 'C': 'cut away in front of the section', 'Esc': 'remove the section', 'T': 'from above', 'R': 'the first view',
    'E': 'heights to scale, and back', 'W': 'triangles', 'G': 'axes', 'D': 'the image laid on, and off', 'P': 'save a picture', '?': 'this help',
  };
  const mouse = { 'drag': 'turn', 'right drag, or Shift and drag': 'move', 'wheel': 'closer or farther, towards the pointer',
                  'point': 'read x, y, z and the value' };
  const fingers = { 'one finger': 'turn', 'two fingers': 'move, closer or farther', 'tap': 'read x, y, z and the value' };
  return make_dialog('Help', h('h3', {}, touch_first ? 'Fingers' : 'Mouse'), table(touch_first ? fingers : mouse),
    h('h3', {}, touch_first ? 'Mouse' : 'Fingers'), table(touch_first ? mouse : fingers), h('h3', {}, 'Keys'), table(keys),
    h('h3', {}, 'Sections'), h('p', {}, 'Press S or Section, then drag a line over the surface. Its ends A and B can be moved. The chart shows the ' +
      'profiles of all visible surfaces; 1 and 2 measure between them.'));
}
