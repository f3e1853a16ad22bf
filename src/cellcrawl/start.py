"""Where the command `cellcrawl` begins: light, so that Ctrl-C finds somebody from the first moment.

Everything else is imported within the ``try``; a package takes up to a second to import.
"""

import sys


def main() -> None:
    """Run the command line; Ctrl-C while it is still loading ends it in one line."""
    try:
        from cellcrawl.command_line.main import main as command_line

        command_line()
    except KeyboardInterrupt:
        print("cellcrawl: stopped", file=sys.stderr)
        sys.exit(130)
