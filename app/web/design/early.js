// Runs before the page is drawn. A form with `data-waits` belongs to a script that loads later; if it is sent before, it
// waits for that script. If the script has not loaded by the end, the browser sends the form, as it does without scripts.
document.addEventListener("submit", (event) => {
  const form = event.target;
  if (!form.matches("[data-waits]")) return;
  event.preventDefault();
  form.dataset.waits = "asked";
});

window.addEventListener("load", () => {
  for (const form of document.querySelectorAll("[data-waits]")) {
    const asked = form.dataset.waits === "asked";
    delete form.dataset.waits;
    if (asked) form.submit();
  }
});
