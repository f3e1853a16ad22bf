"""`python -m cellcrawl`."""

from cellcrawl.start import main

main()
