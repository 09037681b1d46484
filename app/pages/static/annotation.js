// Name, tags and note of a fit: written on its page.

import { send, submitted } from "./api.js";

const form = document.querySelector("#annotation");
if (form) submitted(form, async () => {
  const { name, tags, note } = form.elements;
  const list = tags.value.split(",").map((tag) => tag.trim()).filter(Boolean);
  await send("PUT", form.action, { name: name.value.trim(), tags: list, note: note.value.trim() });
  location.reload();
});
