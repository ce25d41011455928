// The editor of a worksheet: it checks the text while the user types; every action calls the API.
import { Refused, call } from "../shared/api.js";
import { startCompletion } from "../shared/completion.js";
import { startDownloads } from "../shared/downloads.js";
import { Draft } from "../shared/draft.js";
import { isolated } from "../shared/isolated.js";
import { drawDiff } from "./line_diff.js";
import { live } from "../shared/live.js";
import { SheetNames } from "./sheet_names.js";
import { SheetText, replace } from "./sheet_text.js";
import { Typeset, stillThere } from "./typeset.js";

const PAUSE = 300; // pause in typing before a check [ms]
const STALE = 412;
const find = (selector) => document.querySelector(selector);

const form = document.getElementById("sheet"), area = form.elements.text;
const id = form.dataset.worksheet, api = `/api/v1/worksheets/${id}`;
const text = new SheetText(area, find("[data-lines]")), typeset = new Typeset(find("[data-typeset]")), names = new SheetNames(text);
const state = find("[data-state]"), trouble = find("[data-trouble]"), notice = find("[data-draft]"), theirs = find("[data-theirs]");
const isWide = matchMedia("(min-width: 62.01rem)");
let tag = form.dataset.tag, saved = area.defaultValue, draft = draftOf(tag);
let sound = { lines: [], texts: [] }; // the last answer without faults, and its text

const checking = live(
  async (signal) => {
    const sent = area.value, { payload } = await call("POST", "/api/v1/worksheets/check", { text: sent, id }, { signal });
    return { sent, checked: payload };
  },
  ({ sent, checked }) => sent === area.value && show(checked), // otherwise a newer request follows
  (error) => (find("[data-sheet-faults]").textContent = error instanceof Refused ? error.message : "The service does not answer; the sheet is unchanged."),
  PAUSE,
);

// Show the service's answer about a text. With faults, it has the lines that do not depend on faulty ones; other
// unchanged lines stay, with their previous values.
function show(checked, texts = text.texts) {
  const isSound = checked.faults.length === 0;
  if (isSound) sound = { ...checked, texts };
  const shown = new Set(checked.lines.map(({ line }) => line));
  const before = isSound ? [] : stillThere(sound.lines, sound.texts, text.texts).filter(({ line }) => !shown.has(line));
  const lines = [...checked.lines, ...before].sort((a, b) => a.line - b.line);
  text.showFaults(checked.faults);
  typeset.show({ ...checked, lines });
  names.update(checked.names);
  align();
  find("[data-sheet-faults]").textContent = faultsIn(checked.faults);
}

function faultsIn(faults) {
  if (faults.length === 0) return "";
  return `${faults.length} ${faults.length === 1 ? "fault" : "faults"}, ${faults.length > 1 ? "the first " : ""}in line ${faults[0].line}`;
}

// If text and sheet are next to each other, each line is at the height of its text.
function align() {
  typeset.align(text.top, isWide.matches);
}

function draftOf(revision) {
  return new Draft(form, { text: saved }, { of: `worksheet/${id}`, revision: revision.replaceAll(/[":]/g, "") });
}

const isChanged = () => area.value !== saved;

function showDraft() {
  draft.keep();
  notice.hidden = !isChanged();
  state.textContent = isChanged() ? "unsaved changes" : "";
}

area.addEventListener("input", () => {
  text.draw();
  showDraft();
  checking.ask();
});

// Saving

async function save() {
  const sent = area.value;
  trouble.hidden = true;
  state.textContent = "saving …";
  try {
    const answer = await call("PATCH", api, { text: sent }, { headers: { "If-Match": tag } });
    keepAs(sent, answer.tag ?? tag);
    await refresh();
    if (!isChanged()) state.textContent = "saved";
    return true;
  } catch (error) {
    state.textContent = "not saved";
    if (error.status === STALE) await conflict();
    else tell(error);
    return false;
  }
}

// Note the newly stored text; what was typed meanwhile remains a draft.
function keepAs(stored, newTag) {
  draft.forget();
  [saved, tag] = [stored, newTag];
  draft = draftOf(tag);
  theirs.hidden = true;
  showDraft();
}

form.addEventListener("submit", (event) => {
  event.preventDefault();
  if (isChanged()) save();
  else state.textContent = "nothing has changed";
});

document.addEventListener("keydown", (event) => {
  if (event.key.toLowerCase() !== "s" || !(event.ctrlKey || event.metaKey) || event.altKey) return;
  event.preventDefault();
  form.requestSubmit();
});

find("[data-discard]").addEventListener("click", () => {
  replace(area, saved, 0, area.value.length);
  draft.forget();
});

function tell(error, place = trouble) {
  place.replaceChildren(isolated([...(error.faults?.values() ?? [])].join("; ") || error.message));
  place.hidden = false;
  place.scrollIntoView({ block: "nearest" });
}

// After somebody else has saved, show both texts and let the user choose.
async function conflict() {
  const { payload, tag: newest } = await call("GET", api);
  theirs.hidden = false;
  drawDiff(find("[data-theirs-diff]"), area.value, payload.text);
  tell(new Error("Somebody else saved this worksheet meanwhile. Your text is kept; the differences from theirs are shown below."));
  chosen("[data-take-theirs]", () => {
    replace(area, payload.text, 0, area.value.length); // the browser can undo it
    keepAs(payload.text, newest);
    refresh();
  });
  chosen("[data-keep-mine]", () => {
    tag = newest;
    save();
  });
}

function chosen(selector, act) {
  const button = find(selector);
  button.hidden = false;
  button.onclick = () => {
    trouble.hidden = true;
    act();
  };
}

// Life cycle

document.addEventListener("submit", async (event) => {
  const action = event.target.dataset.act;
  if (!action) return;
  event.preventDefault();
  const asked = Object.fromEntries(new FormData(event.target)), button = event.submitter;
  if (button) button.disabled = true;
  if (!isChanged() || (await save())) await act(action, asked);
  if (button) button.disabled = false;
});

async function act(action, asked) {
  try {
    const { version } = asked; // the version to withdraw, not the one being edited
    const body = version ? { ...asked, version: Number(version) } : Object.keys(asked).length ? asked : undefined;
    await call("POST", `${api}/${action}`, body, { headers: version ? {} : { "If-Match": tag } });
    await refresh(action);
  } catch (error) {
    if (error.status === STALE) return conflict();
    await refresh();
    tell(error, find("[data-life-trouble]"));
  }
}

// Reload the parts of the page that show the state.
async function refresh(action) {
  const answer = await fetch(location.pathname, { headers: { Accept: "text/html" } });
  if (!answer.ok) return;
  const page = new DOMParser().parseFromString(await answer.text(), "text/html"), now = page.getElementById("sheet");
  for (const part of document.querySelectorAll("[data-part]")) {
    const fresh = page.querySelector(`[data-part="${part.dataset.part}"]`);
    if (fresh) part.replaceWith(fresh);
  }
  find("[data-save]").textContent = page.querySelector("[data-save]").textContent;
  if (now.elements.text.defaultValue === saved && now.dataset.tag !== tag) keepAs(saved, now.dataset.tag);
  startDownloads();
  if (action) find("[data-part=stages] .next :is(input:not([type=hidden]), button), [data-use] button")?.focus({ preventScroll: true });
}

document.addEventListener("toggle", async (event) => {
  const path = event.target.dataset?.diff;
  if (!path || !event.target.open) return;
  const place = event.target.querySelector("[data-diff-inside]");
  try {
    const { payload } = await call("GET", path);
    drawDiff(place, payload.text, area.value);
  } catch (error) {
    place.replaceChildren(isolated(error.message));
  }
}, true);

function start() {
  startCompletion(form, names);
  const from = draft.restore();
  if (from !== null) text.draw();
  if (from !== null && from !== tag.replaceAll(/[":]/g, "")) tell(new Error("This worksheet was saved after you typed these changes; check them again."));
  showDraft();
  isWide.addEventListener("change", align);
  new ResizeObserver(align).observe(find("[data-lines]"));
  document.fonts.ready.then(align);
  show(JSON.parse(find("[data-checked]").value), area.defaultValue.split("\n"));
  if (area.value !== area.defaultValue) checking.ask();
  startDownloads();
}

start();
