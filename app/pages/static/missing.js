// What is missing: start the search, add what it found, mend a label that is doubted.

import { guarded, send } from "./api.js";
import "./progress.js";

for (const form of document.querySelectorAll("form[data-diagnose]")) {
  onSubmit(form, async () => {
    const time = Number(form.elements.time.value);
    const propose = "propose" in form.dataset;
    const own = form.elements.own?.checked;
    const asked = { fit: form.dataset.diagnose, ...(time > 0 && { time }), ...(own && { own }), ...(propose && { propose }) };
    location.hash = "missing"; // where it says how the search goes, or why it cannot begin
    await send("POST", form.action, asked);
    location.reload();
  });
}

for (const form of document.querySelectorAll("form[data-add]")) {
  onSubmit(form, async () => {
    const { data } = await send("POST", form.dataset.add, wanted(form));
    location.assign(`/fits/${data.id}`);
  });
}

for (const form of document.querySelectorAll("form[data-mend]")) {
  onSubmit(form, async () => {
    const { data: matrix } = await send("POST", form.dataset.mend, JSON.parse(form.dataset.change));
    const { data: fit } = await send("POST", "/api/v1/fits", { ...JSON.parse(form.dataset.again), matrix: matrix.id });
    const links = [link(`/matrices/${matrix.id}`, "the revised data set"), " and ", link(`/fits/${fit.id}`, "its fit")];
    form.querySelector("[role=status]").replaceChildren("Corrected: ", ...links);
    form.querySelector("button").hidden = true;
  });
}

function link(address, text) {
  const made = document.createElement("a");
  made.href = address;
  made.textContent = text;
  return made;
}

// The effects by name, with the definitions of those that are the user's own, and the diagnosis whose refit they are of.
function wanted(form) {
  const fields = new FormData(form);
  const option = form.querySelector("select")?.selectedOptions[0];
  const custom = [...fields.getAll("custom"), option?.dataset.custom].filter(Boolean).map((text) => JSON.parse(text));
  const diagnosis = form.dataset.diagnosis;
  return { effects: fields.getAll("effects"), custom, ...(diagnosis && { diagnosis }) };
}

function onSubmit(form, work) {
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    guarded(form.querySelector("button"), form.querySelector("[role=alert]"), work);
  });
}

// After a search the reader goes on where the answer is, not where the page was scrolled to while it was longer above.
if (location.hash === "#missing") {
  history.scrollRestoration = "manual";
  document.querySelector("#missing-title").focus({ preventScroll: true });
  document.querySelector("#missing").scrollIntoView();
}
