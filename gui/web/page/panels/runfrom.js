/** Run from a line: shows what differs between the machine and the state the program would have there, before anything moves. */

import { h, tableRows } from "../core/dom.js";
import { openDialog } from "../core/dialog.js";
import { _ } from "../core/i18n.js";

/** @param {import("../core/app.js").App} app @param {number} line */
export async function runFrom(app, line) {
  let found;
  try {
    found = await app.call("program.run_from_check", { line });
  } catch {
    return;
  }
  const differences = found.differences.length
    ? h(
        "table",
        { class: "differences" },
        h("thead", null, h("tr", null, [_("What"), _("Now"), _("In the program")].map((text) => h("th", null, text)))),
        h("tbody", null, tableRows(found.differences.map((/** @type {any} */ one) => [one.text ?? one.what, String(one.now), String(one.wanted)]))),
      )
    : h("p", null, _("The machine is in the state that the program expects there."));
  const moves = found.moves?.length
    ? [h("h3", null, _("The machine will first")), h("ol", null, found.moves.map((/** @type {any} */ move) => h("li", { class: "mono" }, move.text)))]
    : [];
  openDialog(
    _("Run from line {line}", { line }),
    [
      found.blocked ? h("p", { class: "notice danger" }, found.blocked) : null,
      h("h3", null, _("Differences")),
      differences,
      ...moves,
      h("p", { class: "notice warn" }, _("Lines before {line} are not executed. Look at the tool, the workpiece and the way to the first point.", { line })),
    ],
    [
      { text: _("Cancel") },
      ...(found.blocked
        ? []
        : [
            {
              text: _("Run from here"), kind: "go",
              act: async (/** @type {() => void} */ close) => {
                if (await app.act("program.run", { line, token: found.token })) close();
              },
            },
          ]),
    ],
    { wide: true },
  );
}
