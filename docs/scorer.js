// Pages that explain come before the reference: who looks for "area" asks whether it stays.
var Scorer = {
  score: ([page, , anchor, , score]) =>
    /^(api|changelog|community|glossary)/.test(page) && !anchor.startsWith("#cellcrawl") ? score - 200 : score,
  objNameMatch: 11,
  objPartialMatch: 1,
  objPrio: { 0: 0, 1: -5, 2: -10 },
  objPrioDefault: 0,
  title: 15,
  partialTitle: 7,
  term: 5,
  partialTerm: 2,
};
