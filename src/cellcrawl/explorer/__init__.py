"""The live cell: a page that runs the package's own solver in a browser.

`explore` makes the page. The solver in it is built from the package's kernels by
``python -m cellcrawl.explorer.build``.
"""

from cellcrawl.explorer.show import Explorer, explore

__all__ = ["Explorer", "explore"]
