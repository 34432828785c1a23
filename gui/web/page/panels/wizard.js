/** The configuration page, where no machine runs: copy a sample, or answer questions and get a configuration that starts. */

import { field, fill, h, select } from "../core/dom.js";
import { _, fromServer } from "../core/i18n.js";
import { iconButton } from "../core/icons.js";
import { registerPanel } from "../core/panels.js";

/** @typedef {import("../core/app.js").App} App */
const HEALTH_MS = 500; // between two looks whether the machine is there

/** @typedef {{key: string, kind: string, text: string, choices: string[], default: any, unit: string, minimum?: number, maximum?: number, when: Record<string, any[]>}} Question */

registerPanel({
  id: "samples",
  title: () => _("Sample machines"),
  icon: "folder",
  order: 1,
  wizard: true,
  async mount(root, app) {
    const samples = await app.call("wizard.samples");
    const result = h("div", { class: "stack" });
    fill(
      root,
      h("h1", null, _("Copy a sample configuration")),
      result,
      h("div", { class: "scroll grow stack" }, samples.map((/** @type {any} */ sample) => sampleCard(app, sample, result))),
    );
  },
});

registerPanel({
  id: "wizard",
  title: () => _("Wizard"),
  icon: "wizard",
  order: 2,
  wizard: true,
  async mount(root, app) {
    const questions = await app.call("wizard.questions");
    const form = new Form(questions);
    const name = h("input", { type: "text", value: "my-machine", class: "code" });
    const result = h("div", { class: "stack" });
    const make = async () => {
      const { errors } = await app.call("wizard.check", { answers: form.answers() });
      form.showErrors(errors);
      if (errors.length) return;
      showResult(app, result, await app.call("wizard.generate", { answers: form.answers(), name: name.value.trim() }));
    };
    fill(
      root,
      h("h1", null, _("A new configuration")),
      h("div", { class: "scroll grow stack" }, form.element, h("div", { class: "card stack" }, field(_("Name of the folder"), name), h("div", { class: "row" }, iconButton("wizard", _("Make the files"), () => make().catch(() => {}), { class: "primary", id: "wizard-make" })), result)),
    );
  },
});

/** @param {App} app @param {any} sample @param {HTMLElement} result */
function sampleCard(app, sample, result) {
  const name = h("input", { type: "text", value: sample.name, "aria-label": _("Name of the copy"), class: "code" });
  const copy = async () => showResult(app, result, await app.call("wizard.copy", { path: sample.path, name: name.value.trim() }));
  return h(
    "div",
    { class: "card stack", data: { sample: sample.path } },
    h("h2", null, sample.name),
    h("p", null, sample.text),
    h("div", { class: "row" }, name, iconButton("save", _("Copy"), () => copy().catch(() => {})), h("span", { class: "muted mono" }, sample.path)),
  );
}

/** @param {App} app @param {HTMLElement} place @param {any} made */
function showResult(app, place, made) {
  fill(
    place,
    h("div", { class: made.check?.length ? "notice warn" : "notice" }, h("p", null, _("The configuration is in {ini}", { ini: made.ini })), (made.files ?? []).map((/** @type {string} */ file) => h("p", { class: "mono muted" }, file)), (made.check ?? []).map((/** @type {string} */ text) => h("p", null, text))),
    h("div", { class: "row" }, iconButton("play", _("Start this machine"), () => startMachine(app, made.ini), { class: "go" })),
  );
}

/** The machine's own server comes up where this one was. @param {App} app @param {string} ini */
async function startMachine(app, ini) {
  if (!(await app.act("wizard.start", { ini }))) return;
  for (;;) {
    await new Promise((resolve) => setTimeout(resolve, HEALTH_MS));
    const health = await fetch("/health").then((answer) => answer.json()).catch(() => null);
    if (health?.machine === "ok") return location.reload();
  }
}

/** The questions as a form; a question with `when` is asked only if other answers fit. */
class Form {
  /** @type {Map<string, {question: Question, element: HTMLElement, read: () => any, error: HTMLElement, unit: HTMLElement}>} */
  #fields = new Map();

  /** @param {Question[]} questions */
  constructor(questions) {
    for (const question of questions) this.#add(question);
    this.element = h("div", { class: "card stack wizard-form", onchange: () => this.#sift() }, [...this.#fields.values()].map((one) => one.element));
    this.#sift();
  }

  /** @param {Question} question */
  #add(question) {
    const { input, read } = control(question);
    const error = h("p", { class: "error", role: "alert" });
    const unit = h("span", { class: "unit" });
    const element = h("div", null, field(label(question), input), error);
    element.firstElementChild.append(unit);
    this.#fields.set(question.key, { question, read, error, unit, element });
  }

  #sift() {
    const answers = this.answers();
    for (const { question, element, unit } of this.#fields.values()) {
      element.hidden = !asked(question.when, answers);
      unit.textContent = question.unit.replace("unit", answers.units); // lengths are in the unit that was chosen
    }
  }

  /** @returns {Record<string, any>} */
  answers() {
    return Object.fromEntries([...this.#fields].map(([key, { read }]) => [key, read()]));
  }

  /** @param {{key: string, text: string}[]} errors */
  showErrors(errors) {
    for (const [key, { error }] of this.#fields) error.textContent = errors.filter((one) => one.key === key).map((one) => one.text).join(" ");
    const first = errors.map((one) => this.#fields.get(one.key)?.element).find(Boolean);
    first?.scrollIntoView({ block: "center" });
  }
}

/** Questions about one axis have its letter before the dot of their key. @param {Question} question */
function label(question) {
  const [axis, rest] = question.key.split(".");
  return rest ? `${axis}: ${fromServer(question.text)}` : fromServer(question.text);
}

/** @param {Question} question */
function control(question) {
  if (question.kind === "choice") {
    const input = select(question.choices.map((choice) => [choice, fromServer(choice)]), question.default, () => {});
    return { input, read: () => input.value };
  }
  if (question.kind === "yesno") {
    const input = select([["yes", _("Yes")], ["no", _("No")]], question.default ? "yes" : "no", () => {});
    return { input, read: () => input.value === "yes" };
  }
  const { minimum: min, maximum: max } = question;
  const input = h("input", { type: "number", step: "any", min, max, value: question.default, class: "number" });
  return { input, read: () => input.valueAsNumber };
}

/** @param {Record<string, any[]>} when other questions' keys with the answers that fit @param {Record<string, any>} answers */
function asked(when, answers) {
  return Object.entries(when).every(([key, fit]) => fit.includes(answers[key]));
}
