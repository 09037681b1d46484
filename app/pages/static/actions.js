// Buttons and forms that change something: start a fit, approve a parameter set.

import { guarded, send } from "./api.js";

for (const form of document.querySelectorAll("form[data-start-fit]")) {
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    guarded(form.querySelector("button"), form.querySelector("[role=alert]"), async () => {
      const fields = new FormData(form);
      const wanted = { ...Object.fromEntries(fields), effects: fields.getAll("effects"), seed: Number(fields.get("seed")) };
      const { data } = await send("POST", form.action, wanted);
      location.assign(`/fits/${data.id}`);
    });
  });
}

for (const button of document.querySelectorAll("button[data-approve]")) {
  button.addEventListener("click", () =>
    guarded(button, document.querySelector("#approve-problem"), async () => {
      await send("POST", button.dataset.approve);
      location.reload();
    }),
  );
}
