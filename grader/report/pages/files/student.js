"use strict";
for (const button of document.querySelectorAll("button.copy")) {
  button.hidden = !navigator.clipboard;
  button.addEventListener("click", () => {
    const lines = [...button.parentElement.querySelectorAll("ins")].map((line) =>
      line.textContent.slice(1),
    );
    navigator.clipboard.writeText(lines.join("\n")).then(() => {
      button.textContent = "Copied";
    });
  });
}

addEventListener("beforeprint", () =>
  document.querySelectorAll("details").forEach((part) => {
    part.open = true;
  }),
);
