// The text of a worksheet: a textarea with transparent letters over its coloured lines, with faults under them.
import { tokens } from "./sheet_tokens.js";

const MOST_FAULTS = 50; // shown at once

const node = (tag, className, textContent = "") => Object.assign(document.createElement(tag), { className, textContent });

export class SheetText {
  constructor(area, lines) {
    Object.assign(this, { area, lines, texts: [], faults: [] });
    area.parentElement.classList.add("coloured");
    this.draw();
    new ResizeObserver(() => this.mark()).observe(lines);
  }

  // Draw the lines that changed; the others keep their elements.
  draw() {
    const texts = this.area.value.split("\n"), old = this.texts;
    let head = 0, tail = 0;
    const most = Math.min(texts.length, old.length);
    while (head < most && texts[head] === old[head]) head += 1;
    while (tail < most - head && texts.at(-1 - tail) === old.at(-1 - tail)) tail += 1;
    const places = this.lines.children;
    for (let place = old.length - tail - 1; place >= head; place -= 1) places[place].remove();
    const next = places[head] ?? null;
    for (const text of texts.slice(head, texts.length - tail)) this.lines.insertBefore(lineOf(text), next);
    this.texts = texts;
    if (head + tail < Math.max(texts.length, old.length)) this.unmark(head, old.length - tail, texts.length - old.length);
  }

  // Hide the faults of changed lines until the next answer; faults below move with their lines.
  unmark(head, end, shift) {
    if (this.faults.length === 0) return;
    this.faults = this.faults
      .filter(({ line }) => line <= head || line > end)
      .map((fault) => (fault.line > end ? { ...fault, line: fault.line + shift } : fault));
    this.mark();
  }

  showFaults(faults) {
    this.faults = faults.slice(0, MOST_FAULTS);
    this.mark();
  }

  // Underline each fault, and show the message in the space under its line.
  mark() {
    for (const old of this.lines.querySelectorAll(".note, .underline")) old.remove();
    for (const line of this.lines.querySelectorAll(".faulty")) line.classList.remove("faulty");
    const frame = this.lines.getBoundingClientRect(), noted = new Set();
    const marks = this.faults.filter((fault) => this.lines.children[fault.line - 1]).map((fault) => ({ fault, box: this.boxOf(fault) }));
    const notes = [];
    for (const { fault, box } of marks) {
      const line = this.lines.children[fault.line - 1];
      line.classList.add("faulty");
      line.append(placed(node("span", "underline"), { left: box.left - frame.left, top: box.bottom - frame.top, width: Math.max(box.width, 8) }));
      if (noted.has(fault.line)) continue; // the other faults are shown in the typeset sheet
      noted.add(fault.line);
      const note = node("span", "note", [fault.message, fault.remedy].filter(Boolean).join(" — "));
      note.title = note.textContent;
      line.append(placed(note, { top: box.bottom - frame.top }));
      notes.push({ note, wanted: box.left - frame.left });
    }
    const gutter = parseFloat(getComputedStyle(this.lines).paddingLeft);
    const widths = notes.map(({ note }) => note.offsetWidth);
    for (const [place, { note, wanted }] of notes.entries()) {
      note.style.left = `${Math.max(gutter, Math.min(wanted, frame.width - widths[place] - 4))}px`;
    }
  }

  // Return the position of a fault's columns; the end of its line if there is no text.
  boxOf({ line, column, end_column: end }) {
    const text = this.texts[line - 1], from = inUnits(text, column - 1), to = end ? inUnits(text, end - 1) : wordEnd(text, from);
    const rects = [...this.range(line - 1, Math.min(from, Math.max(text.length - 1, 0)), Math.max(to, from + 1)).getClientRects()];
    const row = rects.filter(({ bottom }) => bottom === rects[0].bottom); // the first part of a wrapped line
    if (row.length === 0) return this.lines.children[line - 1].firstChild.getBoundingClientRect();
    const left = row[0].left, right = Math.max(...row.map((rect) => rect.right));
    return { left, right, width: right - left, bottom: row[0].bottom };
  }

  // Return the letters of a line as they are drawn.
  range(line, from, to) {
    const range = document.createRange(), code = this.lines.children[line].firstChild;
    let begins = 0, isOpen = false;
    range.selectNodeContents(code);
    for (const part of code.childNodes) {
      const ends = begins + part.textContent.length, letters = part.firstChild;
      if (!isOpen && letters && from <= ends && (from < ends || part === code.lastChild)) {
        range.setStart(letters, from - begins);
        isOpen = true;
      }
      if (isOpen && letters && to <= ends) {
        range.setEnd(letters, to - begins);
        break;
      }
      begins = ends;
    }
    return range;
  }

  // Return the position of the caret, for the list of names.
  caretBox(caret = this.area.selectionStart) {
    const above = this.area.value.slice(0, caret).split("\n"), column = above.at(-1).length;
    const range = this.range(above.length - 1, Math.max(column - 1, 0), column), box = range.getBoundingClientRect();
    return { left: box.right, right: box.right, width: 0, top: box.top, bottom: box.bottom };
  }

  // Return the distance of a line from the top of the text.
  top = (line) => this.lines.children[line - 1]?.offsetTop ?? 0;

  goTo(line, column = 1) {
    const before = this.texts.slice(0, line - 1).reduce((sum, text) => sum + text.length + 1, 0);
    const caret = before + inUnits(this.texts[line - 1] ?? "", column - 1);
    this.area.focus({ preventScroll: true });
    this.area.setSelectionRange(caret, caret);
    this.lines.children[line - 1]?.scrollIntoView({ block: "center" });
  }
}

// Replace a part of the text, so that the browser can undo it.
export function replace(area, text, start, end) {
  area.focus({ preventScroll: true });
  area.setSelectionRange(start, end);
  const isDone = text ? document.execCommand("insertText", false, text) : document.execCommand("delete");
  if (!isDone) {
    area.setRangeText(text, start, end, "end");
    area.dispatchEvent(new Event("input", { bubbles: true }));
  }
}

function lineOf(text) {
  const line = node("div", "line"), code = node("span", "code");
  code.append(...tokens(text).map(({ kind, text: part }) => node("span", kind && `of-${kind}`, part)));
  if (!text) code.append(node("span", "", "​"));
  line.append(code);
  return line;
}

function placed(element, place) {
  for (const [name, size] of Object.entries(place)) element.style[name] = `${size}px`;
  return element;
}

// The service counts characters; a browser counts UTF-16 units, of which some characters need two.
const inUnits = (text, letters) => [...text].slice(0, letters).join("").length;

const wordEnd = (text, from) => from + (text.slice(from).match(/^[\p{L}\p{N}_.]+/u)?.[0].length ?? 1);
