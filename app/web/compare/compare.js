// The page that compares two revisions: another design has other revisions, so its newest is taken at once.

const form = document.querySelector("[data-compare]");

form.querySelector("[data-other]").addEventListener("change", () => {
  form.querySelector("[data-with]").disabled = true; // the service takes the newest revision
  form.requestSubmit();
});
