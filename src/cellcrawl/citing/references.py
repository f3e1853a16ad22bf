"""The papers behind the laws and methods of this package, each once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final


@dataclass(frozen=True)
class Reference:
    """A paper.

    Attributes
    ----------
    key : str
        What BibTeX calls it.
    authors : tuple of str
        Each as "Family, G."
    title, journal, volume, pages, doi : str
        As printed; ``pages`` is the first page or the number of the article.
    year : int
        Of the volume.
    """

    key: str
    authors: tuple[str, ...]
    title: str
    journal: str
    volume: str
    pages: str
    year: int
    doi: str

    def text(self) -> str:
        """Return it in one line, as in a list of references."""
        names = ", ".join(self.authors)
        where = f"{self.journal} {self.volume}".strip()
        what = f"{names.removesuffix('.')}. {self.title}."
        return f"{what} {where}, {self.pages} ({self.year}). doi:{self.doi}"

    def bibtex(self) -> str:
        """Return it as an entry for BibTeX."""
        kind, place = ("article", "journal") if self.volume else ("inproceedings", "booktitle")
        fields = {
            "author": " and ".join(self.authors),
            "title": f"{{{self.title}}}",
            place: self.journal,
            "volume": self.volume,
            "pages": self.pages.replace("–", "--"),
            "year": str(self.year),
            "doi": self.doi,
        }
        lines = [f"  {name} = {{{value}}}," for name, value in fields.items() if value]
        return "\n".join([f"@{kind}{{{self.key},", *lines, "}"])


_ALL: Final = (
    Reference(
        "chen2023",
        ("Chen, Y.", "Saintillan, D.", "Rangamani, P."),
        "Cell motility modes are selected by the interplay of mechanosensitive adhesion and "
        "membrane tension",
        "PRX Life",
        "1",
        "023007",
        2023,
        "10.1103/PRXLife.1.023007",
    ),
    Reference(
        "bell1978",
        ("Bell, G. I.",),
        "Models for the specific adhesion of cells to cells",
        "Science",
        "200",
        "618–627",
        1978,
        "10.1126/science.347575",
    ),
    Reference(
        "sens2020",
        ("Sens, P.",),
        "Stick–slip model for actin-driven cell protrusions, cell polarization, and crawling",
        "Proc. Natl. Acad. Sci. USA",
        "117",
        "24670–24678",
        2020,
        "10.1073/pnas.2011785117",
    ),
    Reference(
        "pereverzev2005",
        (
            "Pereverzev, Y. V.",
            "Prezhdo, O. V.",
            "Forero, M.",
            "Sokurenko, E. V.",
            "Thomas, W. E.",
        ),
        "The two-pathway model for the catch-slip transition in biological adhesion",
        "Biophys. J.",
        "89",
        "1446–1454",
        2005,
        "10.1529/biophysj.105.062158",
    ),
    Reference(
        "chan2008",
        ("Chan, C. E.", "Odde, D. J."),
        "Traction dynamics of filopodia on compliant substrates",
        "Science",
        "322",
        "1687–1691",
        2008,
        "10.1126/science.1163595",
    ),
    Reference(
        "keren2008",
        (
            "Keren, K.",
            "Pincus, Z.",
            "Allen, G. M.",
            "Barnhart, E. L.",
            "Marriott, G.",
            "Mogilner, A.",
            "Theriot, J. A.",
        ),
        "Mechanism of shape determination in motile cells",
        "Nature",
        "453",
        "475–480",
        2008,
        "10.1038/nature06952",
    ),
    Reference(
        "barnhart2015",
        ("Barnhart, E.", "Lee, K.-C.", "Allen, G. M.", "Theriot, J. A.", "Mogilner, A."),
        "Balance between cell–substrate adhesion and myosin contraction determines the frequency "
        "of motility initiation in fish keratocytes",
        "Proc. Natl. Acad. Sci. USA",
        "112",
        "5045–5050",
        2015,
        "10.1073/pnas.1417257112",
    ),
    Reference(
        "lieber2015",
        ("Lieber, A. D.", "Schweitzer, Y.", "Kozlov, M. M.", "Keren, K."),
        "Front-to-rear membrane tension gradient in rapidly moving cells",
        "Biophys. J.",
        "108",
        "1599–1603",
        2015,
        "10.1016/j.bpj.2015.02.007",
    ),
    Reference(
        "shampine1997",
        ("Shampine, L. F.", "Reichelt, M. W."),
        "The MATLAB ODE suite",
        "SIAM J. Sci. Comput.",
        "18",
        "1–22",
        1997,
        "10.1137/S1064827594276424",
    ),
    Reference(
        "hou1994",
        ("Hou, T. Y.", "Lowengrub, J. S.", "Shelley, M. J."),
        "Removing the stiffness from interfacial flows with surface tension",
        "J. Comput. Phys.",
        "114",
        "312–338",
        1994,
        "10.1006/jcph.1994.1170",
    ),
    Reference(
        "kennedy2003",
        ("Kennedy, C. A.", "Carpenter, M. H."),
        "Additive Runge–Kutta schemes for convection–diffusion–reaction equations",
        "Appl. Numer. Math.",
        "44",
        "139–181",
        2003,
        "10.1016/S0168-9274(02)00138-1",
    ),
    Reference(
        "salmon2011",
        ("Salmon, J. K.", "Moraes, M. A.", "Dror, R. O.", "Shaw, D. E."),
        "Parallel random numbers: as easy as 1, 2, 3",
        "Proceedings of SC '11",
        "",
        "1–12",
        2011,
        "10.1145/2063384.2063405",
    ),
    Reference(
        "johnson2008",
        ("Johnson, D. S.", "London, J. M.", "Lea, M.-A.", "Durban, J. W."),
        "Continuous-time correlated random walk model for animal telemetry data",
        "Ecology",
        "89",
        "1208–1215",
        2008,
        "10.1890/07-1032.1",
    ),
    Reference(
        "pincus2007",
        ("Pincus, Z.", "Theriot, J. A."),
        "Comparison of quantitative methods for cell-shape analysis",
        "J. Microsc.",
        "227",
        "140–156",
        2007,
        "10.1111/j.1365-2818.2007.01799.x",
    ),
    Reference(
        "beaumont2002",
        ("Beaumont, M. A.", "Zhang, W.", "Balding, D. J."),
        "Approximate Bayesian computation in population genetics",
        "Genetics",
        "162",
        "2025–2035",
        2002,
        "10.1093/genetics/162.4.2025",
    ),
    Reference(
        "fearnhead2012",
        ("Fearnhead, P.", "Prangle, D."),
        "Constructing summary statistics for approximate Bayesian computation: semi-automatic "
        "approximate Bayesian computation",
        "J. R. Stat. Soc. B",
        "74",
        "419–474",
        2012,
        "10.1111/j.1467-9868.2011.01010.x",
    ),
    Reference(
        "benettin1980",
        ("Benettin, G.", "Galgani, L.", "Giorgilli, A.", "Strelcyn, J.-M."),
        "Lyapunov characteristic exponents for smooth dynamical systems and for Hamiltonian "
        "systems; a method for computing all of them. Part 1: Theory",
        "Meccanica",
        "15",
        "9–20",
        1980,
        "10.1007/BF02128236",
    ),
)
REFERENCES: Final = {reference.key: reference for reference in _ALL}
