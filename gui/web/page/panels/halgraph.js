/** The graph of HAL nets: components as boxes in columns along the way of the data, signals as curves between their pins. */

import { h } from "../core/dom.js";
import { _ } from "../core/i18n.js";

const BOX = 230; // px, width of a component
const PIN = 20;
const HEAD = 26;
const GAP = { x: 120, y: 26 };
const MARGIN = 60; // px, where curves that run back have room

/**
 * @param {{nodes: {id: string, pins: any[]}[], edges: {from: string, to: string, signal: string, from_pin: string, to_pin: string}[]}} net
 * @returns {Element}
 */
export function netGraph(net) {
  if (!net.edges.length) return h("p", { class: "muted" }, _("No nets match the filter."));
  const linked = new Set(net.edges.flatMap((edge) => [edge.from, edge.to]));
  const boxes = place(net.nodes.filter((node) => linked.has(node.id)), net.edges);
  const width = Math.max(...[...boxes.values()].map((box) => box.x)) + BOX + MARGIN;
  const height = Math.max(...[...boxes.values()].map((box) => box.y + box.height)) + 20;
  return h(
    "svg:svg",
    { viewBox: `0 0 ${width} ${height}`, width, height, role: "img", "aria-label": _("Graph of nets") },
    net.edges.map((edge) => curve(edge, boxes)),
    [...boxes.values()].map(drawBox),
  );
}

/** @typedef {{id: string, x: number, y: number, height: number, pins: Map<string, number>}} Box */

/**
 * Columns by the longest way from a source, loops cut where they close; in a column from top to bottom.
 * @param {{id: string}[]} nodes @param {any[]} edges @returns {Map<string, Box>}
 */
function place(nodes, edges) {
  const column = columns(nodes.map((node) => node.id), edges);
  const bottoms = /** @type {number[]} */ ([]);
  /** @type {Map<string, Box>} */
  const boxes = new Map();
  for (const { id } of nodes) {
    const names = [...new Set(edges.flatMap((edge) => [...(edge.from === id ? [edge.from_pin] : []), ...(edge.to === id ? [edge.to_pin] : [])]))].sort();
    const n = column.get(id) ?? 0;
    const y = bottoms[n] ?? 10;
    const height = HEAD + names.length * PIN + 6;
    bottoms[n] = y + height + GAP.y;
    boxes.set(id, { id, x: MARGIN + n * (BOX + GAP.x), y, height, pins: new Map(names.map((name, k) => [name, y + HEAD + k * PIN + PIN / 2])) });
  }
  return boxes;
}

/** @param {string[]} ids @param {any[]} edges @returns {Map<string, number>} */
function columns(ids, edges) {
  /** @type {Map<string, number>} */
  const depth = new Map();
  const open = new Set();
  const visit = (/** @type {string} */ id) => {
    const known = depth.get(id);
    if (known !== undefined) return known;
    if (open.has(id)) return -1; // a loop closes here
    open.add(id);
    const found = 1 + Math.max(-1, ...edges.filter((edge) => edge.to === id && edge.from !== id).map((edge) => visit(edge.from)));
    open.delete(id);
    depth.set(id, found);
    return found;
  };
  ids.forEach(visit);
  return depth;
}

/** @param {any} edge @param {Map<string, Box>} boxes */
function curve(edge, boxes) {
  const from = boxes.get(edge.from);
  const to = boxes.get(edge.to);
  if (!from || !to) return null;
  const [x1, y1, x2, y2] = [from.x + BOX, from.pins.get(edge.from_pin) ?? 0, to.x, to.pins.get(edge.to_pin) ?? 0];
  const bend = Math.max(40, Math.abs(x2 - x1) / 2);
  const below = Math.max(from.y + from.height, to.y + to.height) + 12;
  const way =
    x2 > x1
      ? `M${x1} ${y1}C${x1 + bend} ${y1} ${x2 - bend} ${y2} ${x2} ${y2}`
      : `M${x1} ${y1}C${x1 + 50} ${y1} ${x1 + 50} ${below} ${x1 - 20} ${below}L${x2 + 20} ${below}C${x2 - 50} ${below} ${x2 - 50} ${y2} ${x2} ${y2}`; // back, under the boxes
  return h("svg:path", { class: "edge", d: way }, h("svg:title", null, `${edge.signal}: ${edge.from_pin} → ${edge.to_pin}`));
}

/** @param {Box} box */
function drawBox(box) {
  const short = (/** @type {string} */ name) => (name.startsWith(`${box.id}.`) ? name.slice(box.id.length + 1) : name);
  return h(
    "svg:g",
    { class: "node" },
    h("svg:rect", { x: box.x, y: box.y, width: BOX, height: box.height, rx: 6 }),
    h("svg:text", { class: "head", x: box.x + 8, y: box.y + 18 }, box.id),
    [...box.pins].map(([name, y]) => h("svg:text", { x: box.x + 8, y: y + 4 }, short(name))),
  );
}
