// The names that relations may use: which names fit a field, which one is typed at the caret, and how to insert a name.
import { quantityText, unit } from "../shared/numbers.js";
import { nameOf } from "../shared/typed.js";

const WORD = /[\w.]/;
const BEFORE = /(^|[^\w.])(if|then|else|and|or|not)$/; // words that a name may follow
const FOLLOWS = new Set(["output", "measure"]);

export class Names {
  constructor(list) {
    this.fill(list);
  }

  fill(list) {
    this.list = list;
    this.byName = new Map(list.map((item) => [item.name, item]));
  }

  // A field accepts relations if relations use its name, or if it is a parameter of the design.
  takes(field) {
    return field.matches("input:not([type=hidden])") && !field.name.includes("@") && (field.name.startsWith(".") || this.byName.has(field.name));
  }

  dimensionOf = (field) => (field.name.startsWith(".") ? undefined : this.byName.get(field.name)?.dimension);

  unitOf = (field) => unit(this.byName.get(field.name)?.unit ?? "");

  fits = (item, field) => this.dimensionOf(field) === undefined || item.dimension === this.dimensionOf(field);

  // All names except the field itself and values that depend on it: results of its step, measures of its model.
  for(field) {
    const own = nameOf(field.name), block = field.name.startsWith(".") ? "" : own.split(".")[0];
    return this.list.filter(({ name, role }) => name !== own && !(FOLLOWS.has(role) && name.split(".")[0] === block));
  }

  // Names that contain the typed text: fitting ones first, and among these the ones that begin with it.
  matching(field, typed) {
    const ranks = [[], [], [], []], wanted = typed.toLowerCase();
    for (const item of this.for(field)) {
      const name = item.name.toLowerCase(), place = name.indexOf(wanted);
      if (place < 0 && !item.words.toLowerCase().includes(wanted)) continue;
      const begins = place === 0 || (place > 0 && name[place - 1] === ".");
      ranks[(this.fits(item, field) ? 0 : 2) + (begins ? 0 : 1)].push(item);
    }
    return ranks.flat();
  }

  start = (field) => startOfName(field.value, field.selectionStart);

  put = insert;

  box = (field) => field.getBoundingClientRect();

  // Store the new values of a preview.
  update({ steps = {}, parameters = {} }) {
    const put = (name, quantity) => {
      const item = this.byName.get(name);
      if (item && quantity && typeof quantity === "object") item.value = quantityText(quantity);
    };
    for (const [name, quantity] of Object.entries(parameters ?? {})) put(name, quantity);
    for (const [step, answer] of Object.entries(steps ?? {})) {
      if (answer.state === "pending") continue;
      for (const [name, quantity] of Object.entries({ ...answer.inputs, ...answer.outputs })) put(`${step}.${name}`, quantity);
    }
  }
}

export const isRelation = (text) => text.trimStart().startsWith("=");

// Return where the name before the caret begins; -1 where no name is allowed: outside relations, in numbers, units and texts.
export function startOfName(text, caret) {
  if (!isRelation(text) || caret <= text.indexOf("=")) return -1;
  let start = caret;
  while (start > 0 && WORD.test(text[start - 1])) start -= 1;
  if (start < caret && !/[A-Za-z]/.test(text[start])) return -1;
  const before = text.slice(0, start).trimEnd();
  if (before.split('"').length % 2 === 0) return -1; // within the text of a choice
  return /[\w.)\]"]/.test(before.at(-1) ?? "=") && !BEFORE.test(before) ? -1 : start;
}

// Insert a name into a field: replace its typed part; add "= " in front if there was no relation.
export function insert(field, name, start, end) {
  if (!isRelation(field.value)) {
    field.value = `= ${name}`;
  } else {
    const blank = /[=\w.)]/.test(field.value[start - 1] ?? "") ? " " : "";
    field.setRangeText(`${blank}${name}`, start, end, "end");
  }
  const caret = isRelation(field.value) ? field.selectionEnd : field.value.length;
  field.focus();
  field.setSelectionRange(caret, caret);
  field.dispatchEvent(new Event("input", { bubbles: true }));
}
