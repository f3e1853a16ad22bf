// What the package computed for the page; see `content` in Python.

export const DATA = JSON.parse(document.getElementById("data").textContent);
