// SPDX-License-Identifier: GPL-3.0-or-later
// What is shown, in one place: everything that draws listens for changes.

export function make_state(values) {
  const listeners = [];
  return {
    ...values,
    set(changes) {
      Object.assign(this, changes);
      for (const listener of listeners) listener(changes);
    },
    /** Calls when one of the named values has been set. */
    on(names, listener) {
      listeners.push((changes) => {
        if (names.some((name) => name in changes)) listener(changes);
      });
    },
  };
}

/** Colours of surfaces where each needs its own; told apart also by colour-blind readers. */
const swatches = ['#2f7fd6', '#e07b28', '#23a37a', '#c85a9a', '#8a6fd1', '#b8960c', '#1aa3b8', '#d2493f'];
export const swatch_of = (index) => swatches[index % swatches.length];

export const visible_surfaces = (state, scene) => scene.surfaces.filter((_, i) => state.visible[i]);

/** The box around what is visible, or around everything. */
export function box_of_all(surfaces) {
  const low = [0, 1, 2].map((axis) => Math.min(...surfaces.map((surface) => surface.box.low[axis])));
  const high = [0, 1, 2].map((axis) => Math.max(...surfaces.map((surface) => surface.box.high[axis])));
  return { low, high };
}
