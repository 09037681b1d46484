// The display units that are chosen: kept with the account, so that pages, figures and reports come in them.

import { send, submitted } from "./api.js";

const form = document.querySelector("#units");

submitted(form, async () => {
  const said = form.querySelector("[role=status]");
  said.textContent = "";
  await send("PUT", "/api/v1/display-units", { units: [...new FormData(form).values()].filter(Boolean) });
  said.textContent = "Saved.";
});
