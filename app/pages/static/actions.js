// The button that approves or withdraws a parameter set; why is kept with it.

import { guarded, send } from "./api.js";

for (const button of document.querySelectorAll("button[data-approve]")) {
  button.addEventListener("click", () =>
    guarded(button, document.querySelector("#approve-problem"), async () => {
      await send("POST", button.dataset.approve, { why: document.querySelector("#why").value.trim() });
      location.reload();
    }),
  );
}
