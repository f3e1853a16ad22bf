"""`python -m cellcrawl`."""

from cellcrawl.command_line import main

main()
