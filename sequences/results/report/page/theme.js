"use strict";
// Light or dark: as the system has it, until the button says otherwise. `again` draws what holds colours of its own.

function setUpTheme(again) {
  const button = document.getElementById("theme"), dark = matchMedia("(prefers-color-scheme: dark)");
  const isDark = () => (document.documentElement.dataset.theme || (dark.matches ? "dark" : "light")) === "dark";
  const say = () => (button.textContent = isDark() ? "Light" : "Dark");
  button.hidden = false;
  button.setAttribute("aria-label", "change between light and dark");
  button.addEventListener("click", () => {
    document.documentElement.dataset.theme = isDark() ? "light" : "dark";
    say();
    again();
  });
  dark.addEventListener("change", () => { say(); again(); });
  say();
}
