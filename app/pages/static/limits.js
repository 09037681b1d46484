// Limits: what stands in the table is sent as a whole, and takes the place of what was set before.

import { guarded, send } from "./api.js";

const form = document.querySelector("form[data-limits]");

function limits() {
  const found = {};
  for (const row of form.querySelectorAll("tr[data-name]")) {
    const { lower, upper, unit } = Object.fromEntries([...row.querySelectorAll("input")].map(({ name, value }) => [name, value.trim()]));
    if (lower !== "" || upper !== "") {
      found[row.dataset.name] = { lower: lower === "" ? null : Number(lower), upper: upper === "" ? null : Number(upper), unit };
    }
  }
  return found;
}

form?.addEventListener("submit", (event) => {
  event.preventDefault();
  guarded(form.querySelector("button"), form.querySelector("[role=alert]"), async () => {
    await send("PUT", form.dataset.limits, { batch: form.dataset.batch, limits: limits() });
    location.reload();
  });
});
