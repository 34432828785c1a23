/** The program editor: a text area with line numbers, checked by the interpreter while one types. */

import { fill, h, setFlag, setText } from "../core/dom.js";
import { ask, confirm } from "../core/dialog.js";
import { _ } from "../core/i18n.js";
import { icon } from "../core/icons.js";
import { operator } from "../core/machine.js";

/** @typedef {import("../core/app.js").App} App */

const ROW = 24; // px, as in programs.css
const CHECK_PAUSE_MS = 600;
const CHECK_LIMIT = 2_000_000; // characters; larger texts are checked when they are saved and opened

/**
 * @param {App} app @param {string | null} path null: a new program
 * @param {(path: string | null) => void} leave called with the path that was saved, null if none was
 * @returns {Promise<HTMLElement>}
 */
export async function editor(app, path, leave) {
  const file = path === null ? { text: "", version: null } : await app.call("program.read", { path });
  let { version } = file;
  let saved = /** @type {string} */ (file.text);
  let place = path;
  const title = h("span", { class: "grow mono" }, path ?? _("New program"));
  const area = h("textarea", { class: "code", spellcheck: "false", wrap: "off", value: saved, "aria-label": _("Program text"), id: "editor-text" });
  const gutter = h("div", { class: "gutter", "aria-hidden": "true" });
  const errors = h("div", { class: "scroll errors", role: "list", "aria-label": _("Errors") });
  /** @type {Set<number>} */
  let wrong = new Set();
  const drawTitle = () => setText(title, `${place ?? _("New program")}${area.value === saved ? "" : " ●"}`);
  const drawGutter = () => {
    const first = Math.floor(area.scrollTop / ROW);
    const total = countLines(area.value);
    const rows = [];
    for (let n = first; n < Math.min(first + Math.ceil(area.clientHeight / ROW) + 1, total); n += 1) {
      rows.push(h("div", { class: wrong.has(n + 1) ? "wrong" : "", style: { top: `${n * ROW - area.scrollTop + 8}px` } }, String(n + 1)));
    }
    fill(gutter, rows);
  };
  const check = async () => {
    if (area.value.length > CHECK_LIMIT) return;
    const text = area.value;
    const found = await app.link.call("program.check", { text }).catch(() => null);
    if (!found || text !== area.value) return;
    wrong = new Set(found.errors.map((/** @type {any} */ error) => error.line));
    fill(errors, found.errors.map((/** @type {any} */ error) =>
      h("div", { role: "listitem" }, h("button", { type: "button", class: "plain", onclick: () => goTo(area, error.line, error.column ?? 1) }, _("Line {line}: {text}", { line: error.line, text: error.text }))),
    ));
    setFlag(errors, "hidden", !found.errors.length);
    drawGutter();
  };
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;
  area.addEventListener("input", () => {
    clearTimeout(timer);
    timer = setTimeout(check, CHECK_PAUSE_MS);
    drawTitle();
    drawGutter();
  });
  area.addEventListener("scroll", drawGutter);
  new ResizeObserver(drawGutter).observe(area);

  const saveNow = async () => {
    const target = place ?? (await ask(_("Save"), _("File name"), _("program.ngc")));
    if (!target) return false;
    const text = area.value; // typing goes on meanwhile
    try {
      ({ version } = await app.link.call("program.save", { path: target, text, version }));
    } catch (error) {
      if (/** @type {any} */ (error).code !== "conflict") return app.showError(error), false;
      const ours = await confirm(_("Save"), _("Somebody else has changed {path} meanwhile. Overwrite it with this text?", { path: target }), _("Overwrite"), "danger");
      if (!ours) return false;
      version = /** @type {any} */ (error).details.version;
      return saveNow();
    }
    place = target;
    saved = text;
    drawTitle();
    return true;
  };
  let saving = Promise.resolve(true);
  const save = () => (saving = saving.then(saveNow)); // two at once would both replace the same version
  const close = async () => {
    if (area.value !== saved && !(await confirm(_("Editor"), _("Throw the changes away?"), _("Throw away"), "danger"))) return;
    app.release(element);
    leave(null);
  };
  const why = (/** @type {any} */ v) => (operator(v) ? "" : _("You may watch only"));
  const finish = async () => {
    if (!(await save())) return;
    app.release(element);
    leave(place);
  };
  const element = h(
    "div",
    { class: "editor stack grow" },
    h(
      "div",
      { class: "row" },
      title,
      app.button("save", _("Save"), save, why, { id: "editor-save" }),
      app.button("play", _("Save and open"), finish, why, { id: "editor-open", class: "primary" }),
      h("button", { type: "button", onclick: close, "aria-label": _("Close the editor") }, icon("close")),
    ),
    h("div", { class: "text-area grow" }, gutter, area),
    errors,
  );
  setFlag(errors, "hidden", true);
  if (saved) check();
  return element;
}

/** @param {string} text */
function countLines(text) {
  let lines = 1;
  for (let at = text.indexOf("\n"); at >= 0; at = text.indexOf("\n", at + 1)) lines += 1;
  return lines;
}

/** @param {HTMLTextAreaElement} area @param {number} line @param {number} column */
function goTo(area, line, column) {
  let at = 0;
  for (let n = 1; n < line; n += 1) at = area.value.indexOf("\n", at) + 1;
  area.focus();
  area.setSelectionRange(at + column - 1, at + column);
  area.scrollTop = Math.max((line - 4) * ROW, 0);
}
