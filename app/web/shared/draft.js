// Unsaved changes, stored by the tab of the browser: one draft for each design or worksheet, and revision.
import { reveal } from "./reveal.js";

export class Draft {
  constructor(form, was, { of = form.dataset.design, revision = form.dataset.revision } = {}) {
    Object.assign(this, { form, was, prefix: `draft:${of}:` });
    this.key = this.prefix + revision;
    this.waiting = {}; // typed texts of fields that the page loads later
  }

  fields() {
    return [...this.form.elements].filter((field) => field.name && field.type !== "hidden" && field.name !== "note");
  }

  changed() {
    const differs = (field) => field.value.trim() !== (this.was[field.name] ?? "").trim();
    const here = this.fields().filter(differs).map((field) => [field.name, field.value]);
    return { ...this.waiting, ...Object.fromEntries(here) };
  }

  isChanged() {
    return Object.keys(this.changed()).length > 0;
  }

  // Store the changes; return true if there are any.
  keep() {
    const changed = this.changed();
    for (const field of this.fields()) field.classList.toggle("changed", Object.hasOwn(changed, field.name));
    const any = this.isChanged();
    if (any) sessionStorage.setItem(this.key, JSON.stringify(changed));
    else sessionStorage.removeItem(this.key);
    return any;
  }

  // Restore the draft of this revision, or of an older one if somebody else has saved since; return its revision.
  restore() {
    const keys = Object.keys(sessionStorage).filter((key) => key.startsWith(this.prefix)).sort(byRevision);
    const key = keys.at(-1);
    if (!key) return null;
    this.waiting = JSON.parse(sessionStorage.getItem(key));
    this.fill();
    for (const old of keys) if (old !== this.key) sessionStorage.removeItem(old);
    return key.slice(this.prefix.length);
  }

  // Restore the texts of fields that have been loaded in the meantime.
  fill() {
    for (const field of this.fields().filter(({ name }) => Object.hasOwn(this.waiting, name))) {
      field.value = this.waiting[field.name];
      delete this.waiting[field.name];
      reveal(field);
    }
  }

  forget() {
    sessionStorage.removeItem(this.key);
    this.waiting = {};
  }
}

const byRevision = (one, other) => one.localeCompare(other, "en", { numeric: true });
