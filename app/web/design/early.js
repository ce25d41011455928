// Before the page is drawn: a form with `data-waits` belongs to a script that comes later. What is sent until then waits
// for that script. If it has not come by the end of loading, the browser sends the form, as it does without scripts.
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
