"""What to cite: the software, its model, and the papers behind the laws and methods used."""

from cellcrawl.citing.cite import Citation, Citations, cite
from cellcrawl.citing.references import REFERENCES, Reference

__all__ = ["REFERENCES", "Citation", "Citations", "Reference", "cite"]
