/** Colours of moves by kind, feed or tool; also for the legend. Each is [red, green, blue], 0 to 255. */

import { KIND } from "./data.js";

const KINDS = {
  dark: { [KIND.RAPID]: [140, 156, 173], [KIND.FEED]: [86, 180, 255], [KIND.ARC]: [79, 214, 146], [KIND.PROBE]: [235, 120, 235] },
  light: { [KIND.RAPID]: [105, 118, 130], [KIND.FEED]: [10, 88, 171], [KIND.ARC]: [11, 107, 60], [KIND.PROBE]: [150, 20, 150] },
};
const TOOLS = [[86, 180, 233], [230, 159, 0], [0, 180, 130], [220, 100, 170], [213, 94, 0], [120, 120, 255], [180, 180, 60], [160, 90, 60]];
const RAMP = [[60, 90, 200], [40, 170, 190], [90, 190, 80], [235, 190, 40], [225, 70, 50]]; // slow to fast
const SRGB = Array.from({ length: 256 }, (_unused, value) => {
  const share = value / 255;
  return Math.round(255 * (share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4)); // three.js blends in linear light
});

/**
 * @param {string} colouring @param {import("./data.js").Chunk} chunk @param {number} n @param {number[]} feedRange @param {boolean} dark
 * @returns {number[]} in linear light, as three.js wants it
 */
export function colourOf(colouring, chunk, n, feedRange, dark) {
  const rgb = plainColour(colouring, chunk.kind[n], chunk.feed[n], chunk.tool[n], feedRange, dark);
  return [SRGB[rgb[0]], SRGB[rgb[1]], SRGB[rgb[2]]];
}

/** @param {string} colouring @param {number} kind @param {number} feed @param {number} tool @param {number[]} feedRange @param {boolean} dark */
export function plainColour(colouring, kind, feed, tool, feedRange, dark) {
  const kinds = /** @type {Record<number, number[]>} */ (dark ? KINDS.dark : KINDS.light);
  if (kind === KIND.RAPID || colouring === "kind") return kinds[kind] ?? kinds[KIND.FEED];
  if (colouring === "tool") return TOOLS[tool % TOOLS.length];
  const [low, high] = feedRange;
  return ramp(high > low ? (feed - low) / (high - low) : 0.5);
}

/** @param {number} share 0 to 1 */
function ramp(share) {
  const at = Math.min(Math.max(share, 0), 1) * (RAMP.length - 1);
  const n = Math.min(Math.floor(at), RAMP.length - 2);
  return RAMP[n].map((value, k) => Math.round(value + (RAMP[n + 1][k] - value) * (at - n)));
}

/** @param {number[]} rgb */
export const css = (rgb) => `rgb(${rgb.join(" ")})`;
