// What was typed and not saved, kept by the tab of the browser: one draft for every design or worksheet, and revision.
import { reveal } from "./reveal.js";

export class Draft {
  constructor(form, was, { of = form.dataset.design, revision = form.dataset.revision } = {}) {
    Object.assign(this, { form, was, prefix: `draft:${of}:` });
    this.key = this.prefix + revision;
    this.waiting = {}; // what was typed into fields that the page fetches later
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

  // Keep what differs; true if anything does.
  keep() {
    const changed = this.changed();
    for (const field of this.fields()) field.classList.toggle("changed", Object.hasOwn(changed, field.name));
    const any = this.isChanged();
    if (any) sessionStorage.setItem(this.key, JSON.stringify(changed));
    else sessionStorage.removeItem(this.key);
    return any;
  }

  // Put back what was kept, for this revision; for an older one if somebody else saved since. Returns its revision.
  restore() {
    const keys = Object.keys(sessionStorage).filter((key) => key.startsWith(this.prefix)).sort(byRevision);
    const key = keys.at(-1);
    if (!key) return null;
    this.waiting = JSON.parse(sessionStorage.getItem(key));
    this.fill();
    for (const old of keys) if (old !== this.key) sessionStorage.removeItem(old);
    return key.slice(this.prefix.length);
  }

  // Put what waits for its field into the fields that are there by now.
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
