/** Active G and M codes, feed, speed and the tool in the spindle, as the interpreter has them. */

import { h, setText } from "../core/dom.js";
import { _ } from "../core/i18n.js";

/** @param {import("../core/app.js").App} app @returns {HTMLElement} */
export function activeCodes(app) {
  const codes = h("p", { class: "mono codes", "aria-label": _("Active codes") });
  const tool = h("p", { class: "mono codes" });
  app.store.watch(["gcode_text", "mcode_text", "settings", "tool_in_spindle"], (v) => {
    setText(codes, [...(v.gcode_text ?? []), ...(v.mcode_text ?? [])].join(" "));
    setText(tool, `T${v.tool_in_spindle ?? 0} F${round(v.settings?.[1])} S${round(v.settings?.[2])}`);
  });
  return h("div", { class: "card" }, h("h2", null, _("Active codes")), codes, tool);
}

/** @param {number | undefined} value */
function round(value) {
  return String(Math.round((value ?? 0) * 1000) / 1000);
}
