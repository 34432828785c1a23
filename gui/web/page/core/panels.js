/**
 * Panels and the rail that chooses among them. A panel is one module that calls `registerPanel`; it is mounted when it is
 * first shown, and told whenever it becomes visible or hidden.
 */

import { fill, h, setAttribute, setFlag } from "./dom.js";
import { icon } from "./icons.js";
import { _ } from "./i18n.js";
import { recall, remember } from "./prefs.js";

/**
 * @typedef {object} Mounted what a panel's `mount` may return
 * @property {() => void} [show] it became visible
 * @property {() => void} [hide] it is no longer visible
 *
 * @typedef {object} Panel
 * @property {string} id also the address fragment: `#mdi`
 * @property {() => string} title
 * @property {string} icon a name of core/icons.js
 * @property {number} order place in the rail
 * @property {string} [beside] id of a panel that is shown to the right where there is room
 * @property {boolean} [wizard] shown where no machine runs, and only there
 * @property {(config: any) => boolean} [when] whether this machine has it
 * @property {(root: HTMLElement, app: import("./app.js").App) => Mounted | void | Promise<Mounted | void>} mount
 */

/** @type {Panel[]} */
const registered = [];

/** @param {Panel} panel */
export function registerPanel(panel) {
  registered.push(panel);
  registered.sort((one, other) => one.order - other.order);
}

export class Panels {
  /** @type {Map<string, {section: HTMLElement, mounted: Promise<Mounted | void>}>} */
  #mounted = new Map();
  /** @type {Set<string>} ids that are visible now */
  #visible = new Set();
  /** @type {Panel[]} */
  #panels = [];
  current = "";

  /** @param {import("./app.js").App} app */
  constructor(app) {
    this.app = app;
    window.addEventListener("hashchange", () => this.show(location.hash.slice(1)));
    window.matchMedia("(max-width: 960px)").addEventListener("change", () => this.show(this.current));
  }

  /** Build the rail for this machine and show the panel that was open last. */
  start() {
    const config = this.app.v.config ?? {};
    this.#panels = registered.filter((panel) => Boolean(panel.wizard) === Boolean(config.wizard) && (panel.when?.(config) ?? true));
    const rail = /** @type {HTMLElement} */ (document.getElementById("rail"));
    setAttribute(rail, "aria-label", _("Pages"));
    fill(rail, h("div", { role: "tablist", "aria-orientation": "vertical", class: "tabs" }, this.#panels.map((panel) => this.#tab(panel))));
    rail.onkeydown = (event) => this.#arrows(event);
    const wanted = location.hash.slice(1) || recall("panel", "");
    this.show(this.#find(wanted) ? wanted : this.#panels[0].id);
  }

  /** @param {Panel} panel */
  #tab(panel) {
    return h(
      "button",
      {
        type: "button", role: "tab", id: `tab-${panel.id}`, "aria-controls": `panel-${panel.id}`, "aria-selected": "false",
        onclick: () => this.show(panel.id),
      },
      icon(panel.icon),
      h("span", null, panel.title()),
    );
  }

  /** @param {string} id */
  #find(id) {
    return this.#panels.find((panel) => panel.id === id);
  }

  /** @param {KeyboardEvent} event */
  #arrows(event) {
    const step = { ArrowDown: 1, ArrowRight: 1, ArrowUp: -1, ArrowLeft: -1 }[event.key];
    const tabs = [...document.querySelectorAll("#rail [role=tab]")];
    const at = tabs.indexOf(/** @type {Element} */ (document.activeElement));
    if (!step || at < 0) return;
    event.preventDefault();
    event.stopPropagation();
    const next = /** @type {HTMLElement} */ (tabs[(at + step + tabs.length) % tabs.length]);
    next.focus();
    next.click();
  }

  /** @param {string} id */
  isVisible(id) {
    return this.#visible.has(id);
  }

  /** Show a panel, and beside it the one that it wants there. @param {string} id */
  show(id) {
    const panel = this.#find(id);
    if (!panel) return;
    this.current = id;
    remember("panel", id);
    if (location.hash.slice(1) !== id) history.replaceState(null, "", `#${id}`);
    const narrow = window.matchMedia("(max-width: 960px)").matches;
    const beside = !narrow && panel.beside ? this.#find(panel.beside) : undefined;
    const main = /** @type {HTMLElement} */ (document.getElementById("main"));
    setFlag(main, "data-beside", Boolean(beside));
    const wanted = [panel, ...(beside ? [beside] : [])];
    for (const shown of wanted) this.#mount(shown, main);
    for (const [other, { section }] of this.#mounted) {
      const place = wanted.findIndex((one) => one.id === other);
      section.hidden = place < 0;
      section.style.order = String(place);
      this.#setVisible(other, place >= 0);
    }
    for (const tab of document.querySelectorAll("#rail [role=tab]")) {
      const selected = tab.id === `tab-${id}`;
      setAttribute(tab, "aria-selected", String(selected));
      setAttribute(tab, "tabindex", selected ? "0" : "-1");
    }
  }

  /** @param {Panel} panel @param {HTMLElement} main */
  #mount(panel, main) {
    if (this.#mounted.has(panel.id)) return;
    const section = h("section", { id: `panel-${panel.id}`, role: "tabpanel", tabindex: 0, "aria-labelledby": `tab-${panel.id}`, class: `panel-${panel.id}` });
    main.append(section);
    const mounted = Promise.resolve(panel.mount(section, this.app)).catch((error) => {
      console.error(error);
      fill(section, h("p", { class: "notice danger" }, _("This page failed to load: {reason}", { reason: String(error) })));
    });
    this.#mounted.set(panel.id, { section, mounted });
  }

  /** @param {string} id @param {boolean} visible */
  #setVisible(id, visible) {
    if (this.#visible.has(id) === visible) return;
    if (visible) this.#visible.add(id);
    else this.#visible.delete(id);
    this.#mounted.get(id)?.mounted.then((mounted) => (visible ? mounted?.show?.() : mounted?.hide?.()));
  }
}
