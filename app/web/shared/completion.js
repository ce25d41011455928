// Complete names while they are typed, by keyboard or mouse, in fields for relations and in worksheets.
// `names` defines which fields accept names, where a name begins, which ones fit, and where the list opens.
import { unit } from "./numbers.js";

const MOST = 40; // largest number of options shown; more typing narrows them
const STEPS = { ArrowDown: 1, ArrowUp: -1 };

export function startCompletion(form, names) {
  const list = Object.assign(document.createElement("ul"), { id: "completions", className: "completions", popover: "manual", ariaLabel: "Names" });
  list.setAttribute("role", "listbox");
  document.body.append(list);
  let field = null, options = [], chosen = 0, start = -1, isInserting = false, isFollowing = false;

  const close = () => {
    if (!field) return;
    if (list.matches(":popover-open")) list.hidePopover();
    if (field.role === "combobox") field.setAttribute("aria-expanded", "false");
    field.removeAttribute("aria-activedescendant");
    field = null;
  };

  function open(target) {
    start = names.start(target);
    const typed = start < 0 ? "" : target.value.slice(start, target.selectionStart);
    options = start < 0 ? [] : names.matching(target, typed).slice(0, MOST);
    if (options.length === 0 || (options.length === 1 && options[0].name === typed)) return close();
    field = target;
    list.replaceChildren(...options.map((item, place) => option(item, place, names.fits(item, target))));
    if (!list.matches(":popover-open")) list.showPopover();
    if (!isFollowing) follow();
    if (target.role === "combobox") target.setAttribute("aria-expanded", "true");
    choose(0);
  }

  function choose(place) {
    chosen = (place + options.length) % options.length;
    for (const [at, line] of [...list.children].entries()) line.setAttribute("aria-selected", String(at === chosen));
    field.setAttribute("aria-activedescendant", `completion-${chosen}`);
    list.children[chosen].scrollIntoView({ block: "nearest" });
  }

  function take(place) {
    const target = field;
    isInserting = true;
    names.put(target, options[place].name, start, target.selectionStart);
    isInserting = false;
    close();
  }

  // The field moves while the list is open: by scrolling, and by the messages of a preview.
  function follow() {
    isFollowing = field !== null;
    if (!isFollowing) return;
    place();
    requestAnimationFrame(follow);
  }

  // Below the field, or above it where there is more room; never wider than the window.
  function place() {
    const box = names.box(field), below = innerHeight - box.bottom;
    const isBelow = below > 200 || below > box.top;
    const width = Math.min(Math.max(box.width, 340), innerWidth - 16);
    Object.assign(list.style, {
      left: `${Math.max(8, Math.min(box.left, innerWidth - width - 8))}px`,
      width: `${width}px`,
      maxHeight: `${Math.min(320, (isBelow ? below : box.top) - 12)}px`,
      top: isBelow ? `${box.bottom + 2}px` : "auto",
      bottom: isBelow ? "auto" : `${innerHeight - box.top + 2}px`,
    });
  }

  function watch(input) {
    for (const [name, value] of Object.entries(attributes(input, list.id))) input.setAttribute(name, value);
    input.addEventListener("input", () => isInserting || open(input));
    input.addEventListener("blur", close);
    input.addEventListener("pointerdown", close); // the caret moves
    input.addEventListener("keydown", (event) => onKey(event));
  }

  function onKey(event) {
    if (!field || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key in STEPS) choose(chosen + STEPS[event.key]);
    else if ((event.key === "Enter" || event.key === "Tab") && !event.shiftKey) take(chosen);
    else if (event.key === "Escape") close();
    else if (["ArrowLeft", "ArrowRight", "Home", "End"].includes(event.key)) return close();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  list.addEventListener("mousedown", (event) => {
    event.preventDefault(); // the field keeps the focus
    const line = event.target.closest("[role=option]");
    if (line) take([...list.children].indexOf(line));
  });

  const watchAll = (fields) => [...fields].filter((one) => names.takes(one)).forEach(watch);
  watchAll(form.elements);
  return watchAll; // for fields added later
}

// A one-line field is a combobox; a text area cannot have that role, and does not expand.
function attributes(field, list) {
  const shared = { "aria-autocomplete": "list", "aria-controls": list };
  return field.matches("textarea") ? { ...shared, "aria-haspopup": "listbox" } : { ...shared, role: "combobox", "aria-expanded": "false" };
}

function option(item, place, fits) {
  const line = Object.assign(document.createElement("li"), { id: `completion-${place}`, className: fits ? "" : "other" });
  line.setAttribute("role", "option");
  line.append(part("code", item.name), part("span", item.value || unit(item.unit), "value"), part("small", item.words));
  return line;
}

const part = (tag, textContent, className = "") => Object.assign(document.createElement(tag), { textContent, className });
