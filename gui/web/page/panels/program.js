/** The program panel: the loaded program with its active line and errors, files, editor, run from here. */

import { fill, h, setText } from "../core/dom.js";
import { _ } from "../core/i18n.js";
import { idle, operator, running, whyNoControl, whyNotHomed } from "../core/machine.js";
import { registerPanel } from "../core/panels.js";
import { fileSize } from "../core/units.js";
import { editor } from "./editor.js";
import { programFiles } from "./programfiles.js";
import { ProgramText } from "./programtext.js";
import { runFrom } from "./runfrom.js";

const CHECKED_SIZE = 8_000_000; // bytes; the preview checks larger ones

registerPanel({
  id: "program",
  title: () => _("Program"),
  icon: "program",
  order: 20,
  beside: "path",
  mount(root, app) {
    const text = new ProgramText(app, (line) => app.store.merge({ selected_line: line }));
    const title = h("p", { class: "muted" });
    const edit = async (/** @type {string | null} */ path) => {
      const leave = async (/** @type {string | null} */ saved) => {
        fill(root, view);
        text.redraw();
        if (saved !== null) app.act("program.open", { path: saved });
      };
      try {
        fill(root, await editor(app, path, leave));
      } catch {
        fill(root, view); // the error has been shown
      }
    };
    const why = (/** @type {any} */ v) => (v.program ? "" : _("No program"));
    const from = app.button(
      "right",
      _("Run from here"),
      () => runFrom(app, app.v.selected_line),
      (v) => whyNotHomed(v) || why(v) || (v.selected_line ? "" : _("Choose a line first")),
      { id: "run-from" },
    );
    const view = h(
      "div",
      { class: "stack grow program-view" },
      h(
        "div",
        { class: "row" },
        app.button("folder", _("Open"), () => programFiles(app, edit), (v) => (v.link ? "" : _("No connection")), { class: "primary", id: "program-open" }),
        app.button("edit", _("Edit"), () => edit(app.v.program.path), (v) => why(v) || (operator(v) ? "" : _("You may watch only")) || (!v.program.path || v.program.writable === false ? _("This program cannot be changed here") : running(v) ? _("A program is running") : ""), { id: "program-edit" }),
        app.button("reload", _("Load again"), () => app.act("program.open", { path: app.v.program.path }), (v) => whyNoControl(v) || why(v) || (!v.program.path ? _("This program lies outside the program folder") : idle(v) ? "" : _("A program is running")), { iconOnly: true }),
        from,
      ),
      title,
      text.element,
    );
    fill(root, view);
    app.store.watch(["program"], async (v) => {
      const { program } = v;
      setText(title, program ? `${program.name} · ${_("{n} lines", { n: program.lines })} · ${fileSize(program.size)}${program.filtered ? ` · ${_("made by a filter")}` : ""}` : _("No program is open. Open one, or drop a file into the list."));
      text.load(program);
      app.store.merge({ selected_line: 0 });
      if (!program?.path || program.size > CHECKED_SIZE) return;
      const found = await app.link.call("program.check", { path: program.path }).catch(() => ({ errors: [] }));
      if (app.v.program?.version !== program.version) return;
      for (const error of found.errors) text.errors.set(error.line, error.text);
      text.redraw();
    });
    app.store.watch(["motion_line", "current_line", "interp_state", "task_mode"], (v) => text.setActive(running(v) ? v.motion_line || v.current_line : 0));
    app.store.watch(["selected_line"], (v) => text.select(v.selected_line ?? 0));
    return { show: () => text.redraw() };
  },
});
