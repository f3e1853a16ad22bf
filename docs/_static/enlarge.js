// A picture is a link to its file: many panels are too small to be read in a column of text.
addEventListener("DOMContentLoaded", () => {
  for (const picture of document.querySelectorAll("article img")) {
    if (picture.closest("a")) continue;
    const link = document.createElement("a");
    link.href = picture.src;
    link.className = "enlarge";
    link.title = "Open the picture by itself";
    picture.replaceWith(link);
    link.append(picture);
  }
});
