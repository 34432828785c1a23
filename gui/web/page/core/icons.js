/** The page's pictograms: strokes on a field of 24 by 24, in the colour of the text around them. */

import { h } from "./dom.js";

/** @type {Record<string, string>} name to SVG path data */
const PATHS = {
  manual: "M12 3v18M3 12h18M12 3l-3 3M12 3l3 3M12 21l-3-3M12 21l3-3M3 12l3-3M3 12l3 3M21 12l-3-3M21 12l-3 3",
  program: "M5 3h10l4 4v14H5zM15 3v4h4M8 12h8M8 16h8M8 8h3",
  mdi: "M4 5h16v14H4zM7 10l3 2.5L7 15M12 15h5",
  path: "M4 19l4-9 6 5 6-11M4 19h.01M20 4h.01",
  offsets: "M5 19V5M5 19h14M5 12h6v7M11 12l5-5M16 7h-4M16 7v4",
  tools: "M9 3h6v7l-1 2v6l-2 3-2-3v-6l-1-2zM9 7h6M10 15l4 1.5",
  hal: "M4 6h6v5H4zM14 13h6v5h-6zM10 8.500h3v7h1M4 16h4",
  scope: "M3 4h18v14H3zM6 12c2-7 3-7 4.500 0s2.500 7 4 0 2-4 3.500-4M8 21h8",
  machine: "M4 20h16M6 20V9h12v11M9 9V4h6v5M10 14h4",
  setup: "M12 8.500a3.500 3.500 0 1 0 0 7 3.500 3.500 0 0 0 0-7zM12 3v3M12 18v3M3 12h3M18 12h3M5.600 5.600l2.200 2.200M16.200 16.200l2.200 2.200M5.600 18.400l2.200-2.200M16.200 7.800l2.200-2.200",
  messages: "M4 5h16v11H10l-4 4v-4H4zM8 9h8M8 12h5",
  more: "M5 12h.01M12 12h.01M19 12h.01",
  wizard: "M5 19L15 9M13 7l4 4M18 3v4M16 5h4M6 4v3M4.500 5.500h3M19 15v3M17.500 16.500h3",
  estop: "M8 3h8l5 5v8l-5 5H8l-5-5V8zM9 9l6 6M15 9l-6 6",
  power: "M12 3v8M7 6.500a7.500 7.500 0 1 0 10 0",
  home: "M4 12l8-8 8 8M6.500 10v10h11V10M10 20v-6h4v6",
  play: "M7 4l13 8-13 8z",
  pause: "M7 4v16M17 4v16M8 4v16M16 4v16",
  stop: "M5 5h14v14H5z",
  step: "M5 4l10 8-10 8zM18 4v16",
  folder: "M3 6h6l2 2h10v11H3z",
  edit: "M4 20l1-5L16 4l4 4L9 19zM14 6l4 4",
  rename: "M3 18l4-12 4 12M4.500 14h5M14 12.500a3 3 0 1 0 5 0 3 3 0 0 0-5 0zM19.500 10v8",
  save: "M4 4h13l3 3v13H4zM8 4v5h8V4M8 20v-6h8v6",
  upload: "M12 16V4M12 4l-5 5M12 4l5 5M4 16v4h16v-4",
  reload: "M20 12a8 8 0 1 1-2.500-5.800M20 3v5h-5",
  close: "M5 5l14 14M19 5L5 19",
  sun: "M12 8a4 4 0 1 0 0 8 4 4 0 0 0 0-8zM12 2v3M12 19v3M2 12h3M19 12h3M5 5l2 2M17 17l2 2M5 19l2-2M17 7l2-2",
  moon: "M19 14.500A8 8 0 0 1 9.500 5 8 8 0 1 0 19 14.500z",
  user: "M12 12a4 4 0 1 0 0-8 4 4 0 0 0 0 8zM4 21c0-5 4-7 8-7s8 2 8 7",
  lock: "M6 11h12v10H6zM8 11V8a4 4 0 0 1 8 0v3",
  plus: "M12 5v14M5 12h14",
  minus: "M5 12h14",
  search: "M10.500 4a6.500 6.500 0 1 0 0 13 6.500 6.500 0 0 0 0-13zM15.500 15.500L21 21",
  left: "M20 12H4M4 12l6-6M4 12l6 6",
  right: "M4 12h16M20 12l-6-6M20 12l-6 6",
  up: "M12 20V4M12 4l-6 6M12 4l6 6",
  down: "M12 4v16M12 20l-6-6M12 20l6-6",
  globe: "M12 3a9 9 0 1 0 0 18 9 9 0 0 0 0-18zM3 12h18M12 3c3 3 3 15 0 18M12 3c-3 3-3 15 0 18",
  touchoff: "M12 3v9M9 12h6l-3 5zM4 21h16",
  trash: "M5 7h14M9 7V4h6v3M7 7l1 14h8l1-14",
  embed: "M3 5h18v14H3zM3 9h18M6 7h.01",
  target: "M12 4a8 8 0 1 0 0 16 8 8 0 0 0 0-16zM12 1v6M12 17v6M1 12h6M17 12h6",
};

/**
 * A pictogram for the eye only; the control around it carries the name.
 * @param {string} name @returns {SVGElement}
 */
export function icon(name) {
  return h("svg:svg", { class: "icon", viewBox: "0 0 24 24", "aria-hidden": "true" }, h("svg:path", { d: PATHS[name] ?? PATHS.more }));
}

/**
 * A button with a pictogram.
 * @param {string} name pictogram @param {string} text label, shown unless `iconOnly`
 * @param {() => void} act @param {Record<string, any> & {iconOnly?: boolean}} [properties]
 * @returns {HTMLButtonElement}
 */
export function iconButton(name, text, act, { iconOnly = false, ...properties } = {}) {
  return h(
    "button",
    { type: "button", onclick: act, ...(iconOnly ? { "aria-label": text, title: text } : {}), ...properties },
    icon(name),
    iconOnly ? null : h("span", null, text),
  );
}
