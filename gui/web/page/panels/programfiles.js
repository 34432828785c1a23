/** The dialog that lists the program folder: open, upload, make, rename and remove programs. */

import { fill, h, setText } from "../core/dom.js";
import { ask, confirm, openDialog } from "../core/dialog.js";
import { _ } from "../core/i18n.js";
import { icon, iconButton } from "../core/icons.js";
import { turns } from "../core/link.js";
import { operator, whyNoControl } from "../core/machine.js";
import { fileSize } from "../core/units.js";
import { token } from "../core/token.js";

/** @typedef {import("../core/app.js").App} App */

/** @param {any} v */
const whyNotWrite = (v) => (operator(v) ? "" : _("You may watch only"));

/** @param {App} app @param {(path: string | null) => void} edit called with the file to edit, null for a new one */
export function programFiles(app, edit) {
  const list = h("div", { class: "scroll files", role: "list" });
  const where = h("span", { class: "mono grow" });
  let folder = "";
  const status = h("p", { class: "muted", role: "status" });
  const turn = turns();
  const draw = async (/** @type {string} */ wanted) => {
    const newest = turn();
    try {
      const found = await app.call("program.list", { folder: wanted });
      if (!newest()) return;
      folder = found.folder;
      setText(where, `/${folder}`);
      app.release(list);
      fill(list, wanted ? parentRow(found.parent, draw) : null, found.entries.map((/** @type {any} */ entry) => row(entry)));
      if (!found.entries.length) fill(list, h("p", { class: "muted", role: "listitem" }, _("This folder is empty.")));
    } catch {
      setText(status, _("The folder cannot be read."));
    }
  };
  const open = async (/** @type {string} */ path) => {
    setText(status, _("Opening {path} …", { path }));
    if (await app.act("program.open", { path })) dialog.close();
    else setText(status, "");
  };
  const row = (/** @type {any} */ entry) =>
    h(
      "div",
      { class: "file row", role: "listitem" },
      entry.folder
        ? h("button", { type: "button", class: "plain grow", onclick: () => draw(entry.path) }, icon("folder"), h("span", null, entry.name))
        : app.button("program", entry.name, () => open(entry.path), whyNoControl, { class: "plain grow" }),
      entry.folder ? null : h("span", { class: "muted" }, `${fileSize(entry.size)} · ${new Date(entry.mtime * 1000).toLocaleDateString(document.documentElement.lang)}`),
      entry.folder ? null : fileButtons(app, entry, () => draw(folder), (path) => { dialog.close(); edit(path); }),
    );
  const upload = uploadControl(app, status, async (path) => {
    await draw(folder);
    setText(status, _("{path} is here now.", { path }));
  });
  const dialog = openDialog(
    _("Programs"),
    [
      h("div", { class: "row" }, where, upload, app.button("plus", _("New"), () => { dialog.close(); edit(null); }, whyNotWrite)),
      status,
      list,
    ],
    [{ text: _("Close") }],
    { wide: true, onclose: () => app.release(dialog.element) },
  );
  acceptDrops(dialog.element, (file) => /** @type {any} */ (upload).send(file));
  draw("");
}

/** @param {string} parent @param {(folder: string) => void} draw */
function parentRow(parent, draw) {
  return h("div", { role: "listitem" }, iconButton("up", _("Up"), () => draw(parent ?? ""), { class: "plain" }));
}

/** @param {App} app @param {any} entry @param {() => void} changed @param {(path: string) => void} edit */
function fileButtons(app, entry, changed, edit) {
  const rename = async () => {
    const to = await ask(_("Rename"), _("New name"), entry.name);
    if (to && to !== entry.name && (await app.act("program.rename", { path: entry.path, to }))) changed();
  };
  const remove = async () => {
    if ((await confirm(_("Remove"), _("Remove {name} from the program folder?", { name: entry.name }), _("Remove"), "danger")) && (await app.act("program.remove", { path: entry.path }))) changed();
  };
  return h(
    "span",
    { class: "row" },
    app.button("edit", _("Edit {name}", { name: entry.name }), () => edit(entry.path), whyNotWrite, { iconOnly: true, class: "plain" }),
    app.button("rename", _("Rename {name}", { name: entry.name }), rename, whyNotWrite, { iconOnly: true, class: "plain wide-only" }),
    app.button("trash", _("Remove {name}", { name: entry.name }), remove, whyNotWrite, { iconOnly: true, class: "plain" }),
  );
}

/** @param {App} app @param {HTMLElement} status @param {(path: string) => void} done */
function uploadControl(app, status, done) {
  const input = h("input", { type: "file", class: "visually-hidden", id: "upload-file", tabindex: -1, "aria-hidden": "true", onchange: () => input.files?.[0] && send(input.files[0]) });
  const send = async (/** @type {File} */ file, replace = false) => {
    setText(status, _("Uploading {name} …", { name: file.name }));
    try {
      done((await uploadProgram(file, replace)).path);
    } catch (error) {
      const { code, message } = /** @type {any} */ (error);
      setText(status, "");
      if (code === "exists" && (await confirm(_("Upload"), _("{name} exists. Replace it?", { name: file.name }), _("Replace"), "danger"))) return send(file, true);
      if (code !== "exists") app.notify("error", message);
    }
    input.value = "";
    return undefined;
  };
  const button = app.button("upload", _("Upload"), () => input.click(), whyNotWrite, { id: "upload" });
  return Object.assign(h("span", null, input, button), { send });
}

/** @param {File} file @param {boolean} replace @returns {Promise<{path: string, size: number}>} */
async function uploadProgram(file, replace) {
  const secret = token();
  const answer = await fetch(`/upload?name=${encodeURIComponent(file.name)}&replace=${replace ? 1 : 0}`, {
    method: "POST",
    headers: { "X-Requested-With": "linuxcnc-web", "Content-Type": "application/octet-stream", ...(secret ? { Authorization: `Bearer ${secret}` } : {}) },
    body: file,
  });
  const body = await answer.json().catch(() => ({ text: answer.statusText }));
  if (!answer.ok) throw Object.assign(new Error(body.text), { code: answer.status === 409 ? "exists" : body.code });
  return body;
}

/** Files may be dropped on an element. @param {HTMLElement} element @param {(file: File) => void} take */
function acceptDrops(element, take) {
  element.addEventListener("dragover", (event) => event.preventDefault());
  element.addEventListener("drop", (event) => {
    event.preventDefault();
    const file = event.dataTransfer?.files[0];
    if (file) take(file);
  });
}
