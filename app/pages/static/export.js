// A machine as a file: what cannot be written is said beside the form, not on a page of its own.

import { fetched, submitted } from "./api.js";

for (const form of document.querySelectorAll("form[data-export]")) {
  submitted(form, async () => {
    const asked = new URLSearchParams([...new FormData(form)].filter(([name, value]) => name !== "format" && value.trim()));
    const { file, name } = await fetched(`${form.action}.${form.elements.format.value}?${asked}`);
    const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(file), download: name });
    link.click();
    URL.revokeObjectURL(link.href);
  });
}
