/** The forecast's time line under the picture: sections by tool, a cursor to drag, and where the machine is now. */

import { fill, h, setFlag, setText } from "../core/dom.js";
import { _ } from "../core/i18n.js";
import { duration } from "../core/units.js";
import { AXES, entryAt } from "./data.js";

/**
 * @param {import("./data.js").PathData} data
 * @param {(point: ArrayLike<number> | null, line: number) => void} point called while the cursor is dragged
 */
export function timeline(data, point) {
  const bands = h("div", { class: "bands", "aria-hidden": "true" });
  const now = h("div", { class: "now", hidden: true });
  const input = h("input", { type: "range", min: 0, max: 1, step: "any", value: 0, "aria-label": _("Time in the program") });
  const text = h("output", { class: "mono" });
  const element = h("div", { class: "timeline", hidden: true }, h("div", { class: "track" }, bands, now, input), text);
  /** @type {Int32Array | null} number of the last move of each forecast entry */
  let moves = null;

  input.addEventListener("input", () => {
    if (!data.forecast) return;
    moves ??= movesOfEntries(data);
    const entry = entryAt(data.forecast.times, input.valueAsNumber);
    const move = data.move(moves[entry]);
    const line = data.forecast.lines[entry];
    setText(text, `${duration(input.valueAsNumber)} · ${_("line {line}", { line })}`);
    point(move ? move.chunk.end.subarray(move.n * AXES, move.n * AXES + AXES) : null, line);
  });

  return {
    element,
    reset() {
      moves = null;
      setFlag(element, "hidden", !data.forecast);
      if (!data.forecast) return;
      const { seconds, sections } = data.forecast;
      input.max = String(seconds);
      input.value = "0";
      setText(text, duration(seconds));
      fill(bands, sections.map((section) =>
        h("span", { style: { flexGrow: String(section.motion + (section.pauses ?? 0) || 1e-6) }, title: section.text ?? "" }, section.tool ? `T${section.tool}` : ""),
      ));
    },
    /** @param {number | undefined} time */
    setNow(time) {
      setFlag(now, "hidden", time === undefined || !data.forecast);
      if (time === undefined || !data.forecast) return;
      now.style.left = `${(100 * time) / Math.max(data.forecast.seconds, 1e-6)}%`;
    },
  };
}

/**
 * Walk through moves and forecast together. Both are in the order of execution, so the next move belongs to this entry or
 * to a later one.
 * @param {import("./data.js").PathData} data
 */
function movesOfEntries(data) {
  const { lines } = /** @type {NonNullable<typeof data.forecast>} */ (data.forecast);
  const found = new Int32Array(lines.length);
  const lineOf = new Uint32Array(data.moves);
  for (const chunk of data.chunks) lineOf.set(chunk.line, chunk.first);
  let next = 1; // the first entry of the path is the start, not a move
  for (let entry = 0; entry < lines.length; entry += 1) {
    while (next < lineOf.length && lineOf[next] === lines[entry]) next += 1;
    found[entry] = Math.max(next - 1, 0);
  }
  return found;
}
