/** Pages that the integrator embeds ([DISPLAY]EMBED_TAB_* with an address), each in a sandboxed frame of its own. */

import { fill, h } from "../core/dom.js";
import { registerPanel } from "../core/panels.js";

const FIRST_PLACE = 200;

/** Called once the configuration is known. @param {any[]} tabs `config.embed_tabs` */
export function registerEmbedded(tabs) {
  tabs.forEach((tab, n) =>
    registerPanel({
      id: `embed-${n}`,
      title: () => tab.name,
      icon: "embed",
      order: FIRST_PLACE + n,
      mount(root) {
        fill(root, h("iframe", { src: tab.url, title: tab.name, sandbox: "allow-scripts allow-forms allow-same-origin", referrerpolicy: "no-referrer", class: "embedded grow" }));
      },
    }),
  );
}
