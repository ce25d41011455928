// Names for completion in the text of a worksheet: its own names, functions, units and keywords.
import { replace } from "./sheet_text.js";
import { completions, wordAt } from "./sheet_tokens.js";

export class SheetNames {
  constructor(text) {
    this.text = text;
    this.names = [];
    this.refused = new Set(text.area.dataset.refused.split(" ")); // statements that this text cannot have
  }

  // Return the names that the service read, or the previous ones if it could not read the text.
  update(names) {
    if (names.length) this.names = names;
  }

  takes = (field) => field === this.text.area;

  word = (field) => (field.selectionStart === field.selectionEnd ? wordAt(field.value, field.selectionStart) : null);

  start = (field) => this.word(field)?.start ?? -1;

  matching(field) {
    const word = this.word(field);
    const items = word ? completions(word, [...this.names, ...declared(field.value, new Set(this.names.map(({ name }) => name)), word)]) : [];
    return word?.kind === "statement" ? items.filter(({ name }) => !this.refused.has(name)) : items;
  }

  fits = () => true;

  put = (field, name, start, end) => replace(field, name, start, end);

  box = () => this.text.caretBox();
}

const DECLARATION = /^(?:(?:given|choice|curve|solve)\s+)?([\p{L}_][\p{L}\p{N}_]*)(?:\s*\[([^\]]*)\]|\s*[(=])[^"\n]*(?:"([^"\n]*)")?/gmu;

// Return names that the service has not read yet, because the text is incomplete.
function declared(text, listed, { start }) {
  const matches = [...text.matchAll(DECLARATION)].filter(({ index, 1: name }) => !listed.has(name) && (index > start || index + name.length < start));
  return matches.map(([, name, unit = "", words = ""]) => ({ name, unit, words }));
}
