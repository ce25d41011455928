// The page that compares two revisions. When another design is chosen, its newest revision is compared at once.

const form = document.querySelector("[data-compare]");

form.querySelector("[data-other]").addEventListener("change", () => {
  form.querySelector("[data-with]").disabled = true; // without a number the service uses the newest revision
  form.requestSubmit();
});
