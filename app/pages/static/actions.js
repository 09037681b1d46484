// The button that approves a parameter set.

import { guarded, send } from "./api.js";

for (const button of document.querySelectorAll("button[data-approve]")) {
  button.addEventListener("click", () =>
    guarded(button, document.querySelector("#approve-problem"), async () => {
      await send("POST", button.dataset.approve);
      location.reload();
    }),
  );
}
