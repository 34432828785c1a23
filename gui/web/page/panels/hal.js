/** The HAL panel: every pin, signal and parameter with its value, meters for the chosen ones, and the graph of nets. */

import { fill, h, setPressed, setText } from "../core/dom.js";
import { ask } from "../core/dialog.js";
import { _ } from "../core/i18n.js";
import { iconButton } from "../core/icons.js";
import { turns } from "../core/link.js";
import { whyNoControl } from "../core/machine.js";
import { registerPanel } from "../core/panels.js";
import { recall, remember } from "../core/prefs.js";
import { netGraph } from "./halgraph.js";

/** @typedef {import("../core/app.js").App} App */

const WATCHED = 480; // names; the server takes 500
const ROWS_OPENED = 80; // with fewer items found every group is open
const FILTER_PAUSE_MS = 200;
const KINDS = /** @type {[string, () => string][]} */ ([["pin", () => _("Pins")], ["sig", () => _("Signals")], ["param", () => _("Parameters")]]);

registerPanel({
  id: "hal",
  title: () => "HAL",
  icon: "hal",
  order: 70,
  mount(root, app) {
    const values = new LiveValues(app);
    const meters = meterShelf(values);
    const search = h("input", { type: "search", class: "grow", placeholder: _("Filter: words that must all occur"), "aria-label": _("Filter"), id: "hal-filter" });
    const wanted = new Set(["pin", "sig"]);
    const kinds = KINDS.map(([kind, text]) => {
      const button = h("button", { type: "button", "aria-pressed": String(wanted.has(kind)), onclick: () => {
        if (!wanted.delete(kind)) wanted.add(kind);
        setPressed(button, wanted.has(kind));
        read();
      } }, text());
      return button;
    });
    const tree = h("div", { class: "scroll grow hal-tree" });
    const graph = h("div", { class: "scroll grow hal-graph", hidden: true });
    const count = h("span", { class: "muted" });
    let asGraph = false;
    const toggle = h("button", { type: "button", "aria-pressed": "false", onclick: () => {
      asGraph = !asGraph;
      setPressed(toggle, asGraph);
      tree.hidden = asGraph;
      graph.hidden = !asGraph;
      read();
    } }, _("Graph of nets"));
    const turn = turns();
    const read = async () => {
      const newest = turn();
      const nets = asGraph;
      const asked = nets ? app.call("hal.nets", { filter: search.value }) : app.call("hal.tree", { filter: search.value, kinds: [...wanted] });
      const found = await asked.catch(() => null);
      if (!found || !newest()) return;
      if (nets) fill(graph, netGraph(found));
      else drawTree(app, tree, count, found, values, meters.add);
    };
    /** @type {ReturnType<typeof setTimeout> | undefined} */
    let timer;
    search.addEventListener("input", () => {
      clearTimeout(timer);
      timer = setTimeout(read, FILTER_PAUSE_MS);
    });
    fill(
      root,
      meters.element,
      h("div", { class: "card stack grow" }, h("div", { class: "row" }, search, h("div", { class: "segments" }, kinds), toggle, iconButton("reload", _("Read again"), read, { iconOnly: true }), count), tree, graph),
    );
    return {
      show() {
        read();
        values.start();
      },
      hide: () => values.stop(),
    };
  },
});

/** Values that change on the screen: asks the server for those that are shown. */
class LiveValues {
  /** @type {Map<string, Set<(value: any) => void>>} */
  #listeners = new Map();
  #running = false;
  #asked = false;

  /** @param {App} app */
  constructor(app) {
    this.app = app;
    app.link.on("hal", (frame) => {
      for (const [name, value] of Object.entries(frame.values)) for (const listener of this.#listeners.get(name) ?? []) listener(value);
    });
    app.link.on("hello", () => this.#ask());
  }

  /** @param {string} name @param {(value: any) => void} listener @returns {() => void} ends it */
  watch(name, listener) {
    if (!this.#listeners.has(name)) this.#listeners.set(name, new Set());
    this.#listeners.get(name)?.add(listener);
    this.#ask();
    return () => {
      this.#listeners.get(name)?.delete(listener);
      if (!this.#listeners.get(name)?.size) this.#listeners.delete(name);
      this.#ask();
    };
  }

  start() {
    this.#running = true;
    this.#ask();
  }

  stop() {
    this.#running = false;
    this.app.link.call("hal.watch", { names: [] }).catch(() => {});
  }

  /** Tell the server once, after all changes of this moment. */
  #ask() {
    if (this.#asked || !this.#running) return;
    this.#asked = true;
    setTimeout(() => {
      this.#asked = false;
      if (this.#running) this.app.link.call("hal.watch", { names: [...this.#listeners.keys()].slice(0, WATCHED) }).catch(() => {});
    }, 50);
  }
}

/** @param {any} value */
export function halText(value) {
  if (typeof value === "boolean") return value ? "TRUE" : "FALSE";
  if (typeof value === "number" && !Number.isInteger(value)) return String(Number(value.toPrecision(7)));
  return String(value ?? "");
}

/**
 * @param {App} app @param {HTMLElement} tree @param {HTMLElement} count @param {any} found
 * @param {LiveValues} values @param {(name: string) => void} addMeter
 */
function drawTree(app, tree, count, found, values, addMeter) {
  setText(count, found.total > found.items.length ? _("{n} of {total}", { n: found.items.length, total: found.total }) : String(found.total));
  /** @type {Map<string, any[]>} */
  const groups = new Map();
  for (const item of found.items) {
    const group = item.kind === "sig" ? _("Signals") : item.owner || item.name.split(".")[0];
    groups.set(group, [...(groups.get(group) ?? []), item]);
  }
  for (const details of tree.querySelectorAll("details")) /** @type {any} */ (details).empty?.();
  app.release(tree);
  fill(tree, [...groups].map(([name, items]) => group(app, name, items, found.items.length <= ROWS_OPENED, values, addMeter)));
}

/** @param {App} app @param {string} name @param {any[]} items @param {boolean} open @param {LiveValues} values @param {(name: string) => void} addMeter */
function group(app, name, items, open, values, addMeter) {
  const place = h("div");
  /** @type {(() => void)[]} */
  let ends = [];
  const empty = () => {
    for (const end of ends) end();
    ends = [];
    fill(place);
  };
  const draw = () => {
    empty();
    if (!details.open) return;
    fill(place, items.map((item) => {
      const { element, end } = itemRow(app, item, values, addMeter);
      ends.push(end);
      return element;
    }));
  };
  const details = h("details", { ontoggle: draw, open }, h("summary", null, h("strong", null, name), " ", h("span", { class: "muted" }, String(items.length))), place);
  return Object.assign(details, { empty });
}

/** @param {App} app @param {any} item @param {LiveValues} values @param {(name: string) => void} addMeter */
function itemRow(app, item, values, addMeter) {
  const value = h("output", { class: "mono value", data: { type: item.type } });
  const show = (/** @type {any} */ now) => {
    setText(value, halText(now));
    value.dataset.on = String(now === true);
  };
  show(item.value);
  const set = async () => {
    const text = await ask(item.name, _("New value"), value.textContent ?? "");
    if (text === null) return;
    app.act("hal.set", { name: item.name, value: item.type === "bit" ? /^(1|true|on|yes)$/i.test(text) : Number(text) });
  };
  const element = h(
    "div",
    { class: "hal-item", data: { name: item.name } },
    h("span", { class: "mono name" }, item.name),
    h("span", { class: "muted" }, [item.type, item.dir].filter(Boolean).join(" ")),
    h("span", { class: "mono muted signal" }, item.signal ? `${item.dir === "OUT" ? "⇒" : "⇐"} ${item.signal}` : ""),
    value,
    item.writable && app.v.config.hal_write ? app.button("edit", _("Set {name}", { name: item.name }), set, whyNoControl, { iconOnly: true, class: "plain" }) : null,
    iconButton("plus", _("Meter for {name}", { name: item.name }), () => addMeter(item.name), { iconOnly: true, class: "plain" }),
  );
  return { element, end: values.watch(item.name, show) };
}

/** Large values of the chosen pins, remembered by the browser. @param {LiveValues} values */
function meterShelf(values) {
  const element = h("div", { class: "meters" });
  /** @type {Map<string, () => void>} */
  const shown = new Map();
  const keep = () => remember("meters", [...shown.keys()]);
  const add = (/** @type {string} */ name) => {
    if (shown.has(name)) return;
    const value = h("output", { class: "mono" });
    const end = values.watch(name, (now) => setText(value, halText(now)));
    const meter = h("div", { class: "card meter" }, h("span", { class: "muted mono" }, name), value, iconButton("close", _("Remove {name}", { name }), () => {
      shown.get(name)?.();
      shown.delete(name);
      meter.remove();
      keep();
    }, { iconOnly: true, class: "plain" }));
    shown.set(name, end);
    element.append(meter);
    keep();
  };
  for (const name of recall("meters", /** @type {string[]} */ ([]))) add(name);
  return { element, add };
}
