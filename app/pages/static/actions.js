// Buttons and forms that change something: start a fit, approve a parameter set.

import { guarded, send } from "./api.js";

for (const form of document.querySelectorAll("form[data-start-fit]")) {
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    guarded(form.querySelector("button"), form.querySelector("[role=alert]"), async () => {
      const wanted = Object.fromEntries(new FormData(form));
      const { data } = await send("POST", form.action, { ...wanted, seed: Number(wanted.seed) });
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
