// Raw runs that may go: the button asks once more, and removes what stands in the table.

import { guarded, send } from "./api.js";

const button = document.querySelector("button[data-digest]");

button?.addEventListener("click", () => {
  if (button.dataset.sure === undefined) {
    button.dataset.sure = "";
    button.textContent = "Remove them for good";
    return;
  }
  guarded(button, document.querySelector("#retention-problem"), async () => {
    await send("POST", "/api/v1/retention", { digest: button.dataset.digest });
    location.reload();
  });
});
