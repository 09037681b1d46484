// The form that deletes a fit; its data set is what stays.

import { send, submitted } from "./api.js";

const form = document.querySelector("#deletion");
if (form) submitted(form, async () => {
  await send("DELETE", form.action);
  location.assign(form.dataset.then);
});
