"""The live cell: a page that runs the package's own solver in a browser."""
