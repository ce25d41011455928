// What was typed and not saved, kept by the tab of the browser: one draft for every design or worksheet, and revision.
import { reveal } from "./reveal.js";

export class Draft {
  constructor(form, was, { of = form.dataset.design, revision = form.dataset.revision } = {}) {
    Object.assign(this, { form, was, prefix: `draft:${of}:` });
    this.key = this.prefix + revision;
  }

  fields() {
    return [...this.form.elements].filter((field) => field.name && field.type !== "hidden" && field.name !== "note");
  }

  changed() {
    const differs = (field) => field.value.trim() !== (this.was[field.name] ?? "").trim();
    return Object.fromEntries(this.fields().filter(differs).map((field) => [field.name, field.value]));
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
    const kept = JSON.parse(sessionStorage.getItem(key));
    for (const field of this.fields().filter(({ name }) => Object.hasOwn(kept, name))) {
      field.value = kept[field.name];
      reveal(field);
    }
    for (const old of keys) if (old !== this.key) sessionStorage.removeItem(old);
    return key.slice(this.prefix.length);
  }

  forget() {
    sessionStorage.removeItem(this.key);
  }
}

const byRevision = (one, other) => one.localeCompare(other, "en", { numeric: true });
