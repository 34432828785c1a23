/** The system panel: processes, NML buffers, realtime threads with the time that their functions take, and who is connected. */

import { fill, h } from "../core/dom.js";
import { _ } from "../core/i18n.js";
import { registerPanel } from "../core/panels.js";
import { clock, fileSize } from "../core/units.js";

const PERIOD_MS = 1000;

registerPanel({
  id: "system",
  title: () => _("System"),
  icon: "machine",
  order: 90,
  mount(root, app) {
    const processes = h("tbody");
    const buffers = h("tbody");
    const threads = h("tbody");
    const clients = h("tbody");
    const read = async () => {
      const found = await app.link.call("system.processes").catch(() => null);
      if (!found) return;
      fill(processes, found.processes.map((/** @type {any} */ one) => row([one.name, one.pid, percent(100 * one.cpu), one.memory == null ? "" : fileSize(one.memory), one.alive ? _("alive") : _("gone")], one.alive ? "" : "gone")));
      fill(buffers, found.buffers.map((/** @type {any} */ one) => row([one.buffer, one.kind, one.type, one.messages, one.per_s?.toFixed(0), one.waiting, one.age_s == null ? "" : `${one.age_s.toFixed(2)} s`])));
      fill(threads, found.threads.flatMap(threadRows));
    };
    app.store.watch(["clients", "control"], (v) =>
      fill(clients, (v.clients ?? []).map((/** @type {any} */ one) => row([one.name, one.role === "operator" ? _("Operator") : _("Reader"), one.address, clock(one.since), v.control?.client === one.id ? _("has the controls") : ""]))),
    );
    fill(
      root,
      table(_("Processes"), [_("Name"), "PID", "CPU", _("Memory"), _("State")], processes),
      table(_("Realtime threads"), [_("Name"), _("Period, µs"), _("Time, µs"), _("Longest, µs"), _("Share")], threads),
      table(_("NML buffers"), [_("Name"), _("Kind"), _("Message"), _("Messages"), _("per second"), _("Waiting"), _("Age")], buffers),
      table(_("Screens"), [_("Name"), _("Role"), _("Address"), _("Since"), _("Controls")], clients),
    );
    /** @type {ReturnType<typeof setInterval> | undefined} */
    let timer;
    return {
      show() {
        read();
        timer = setInterval(read, PERIOD_MS);
      },
      hide: () => clearInterval(timer),
    };
  },
});

/** @param {string} title @param {string[]} heads @param {HTMLElement} body */
function table(title, heads, body) {
  return h("div", { class: "card" }, h("h2", null, title), h("div", { class: "scroll" }, h("table", { "aria-label": title, class: "system" }, h("thead", null, h("tr", null, heads.map((text) => h("th", null, text)))), body)));
}

/** @param {any[]} cells @param {string} [kind] */
function row(cells, kind = "") {
  return h("tr", { class: kind }, cells.map((cell, n) => h(n ? "td" : "th", n ? { class: "mono" } : { scope: "row" }, String(cell ?? ""))));
}

/** @param {any} thread times in ns */
function threadRows(thread) {
  const micro = (/** @type {number} */ ns) => (ns / 1000).toFixed(1);
  const functions = thread.functs ?? [];
  return [
    row([thread.name, micro(thread.period), micro(thread.time), micro(thread.tmax), percent((100 * thread.time) / thread.period)], "current"),
    ...functions.map((/** @type {any} */ one) => row([`· ${one.name}`, "", micro(one.time), micro(one.tmax), percent((100 * one.time) / thread.period)])),
  ];
}

/** @param {number | null | undefined} value */
function percent(value) {
  return value == null ? "" : `${value.toFixed(1)} %`;
}
