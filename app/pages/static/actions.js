// The form that approves or withdraws a parameter set; the reason is kept with it.

import { send, submitted } from "./api.js";

for (const form of document.querySelectorAll("form[data-approve]")) {
  submitted(form, async () => {
    await send("POST", form.dataset.approve, { why: form.elements.why.value.trim() });
    location.reload();
  });
}
