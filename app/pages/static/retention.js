// Raw data eligible for deletion: the button asks once more, and removes what stands in the table.

import { guarded, send } from "./api.js";

const button = document.querySelector("button[data-digest]");

button?.addEventListener("click", () => {
  if (button.dataset.sure === undefined) {
    button.dataset.sure = "";
    button.textContent = "Delete the raw data for good";
    return;
  }
  guarded(button, document.querySelector("#retention-problem"), async () => {
    await send("POST", "/api/v1/retention", { digest: button.dataset.digest });
    location.reload();
  });
});
