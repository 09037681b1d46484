// A lab's own effects: keep a proposed term under a name, delete one from the list.

import { guarded, send } from "./api.js";

for (const form of document.querySelectorAll("form[data-keep]")) {
  onSubmit(form, async () => {
    const { keep: diagnosis, proposal } = form.dataset;
    const asked = { name: form.elements.name.value.trim(), diagnosis, proposal: Number(proposal) };
    const { data } = await send("POST", form.action, asked);
    form.hidden = true;
    const said = form.nextElementSibling;
    said.replaceChildren(mark(`Saved as ${data.name}`), ". Every fit with a suitable model now offers it under Own effects.");
  });
}

for (const form of document.querySelectorAll("form[data-drop]")) {
  onSubmit(form, async () => {
    await send("DELETE", form.dataset.drop);
    location.reload();
  });
}

function mark(text) {
  const made = document.createElement("span");
  made.className = "state approved";
  made.textContent = text;
  return made;
}

function onSubmit(form, work) {
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    guarded(form.querySelector("button"), form.querySelector("[role=alert]"), work);
  });
}
