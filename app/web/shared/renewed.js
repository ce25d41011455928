// Replace the content of this page by the server's present version, without a reload.
// If that fails, show a message in `words`.
export async function renewed(words) {
  try {
    const answer = await fetch(location.href, { headers: { Accept: "text/html" } });
    if (!answer.ok) throw new Error(`answer ${answer.status}`);
    const page = new DOMParser().parseFromString(await answer.text(), "text/html");
    document.querySelector("main").replaceWith(document.adoptNode(page.querySelector("main")));
  } catch (error) {
    words.textContent = `The job has ended, but the page could not be loaded: ${error.message}. Reload the page.`;
  }
}
