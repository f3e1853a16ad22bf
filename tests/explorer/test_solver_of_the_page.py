"""The shipped module in node, against the package in Python."""

from __future__ import annotations

from importlib import resources
from pathlib import Path

import numba
import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.explorer import links, sources
from cellcrawl.explorer.content import content
from cellcrawl.explorer.object_file import imports
from cellcrawl.explorer.show import MODULE, shipped_module
from tests.explorer import node

CODE = """
const module = new WebAssembly.Module(fs.readFileSync(given.module));
return given.runs.map(({link, times}) => {
  const {setup} = $link.read(link);
  const run = new $run.Run(module, setup);
  const seen = times.map((time) => {
    run.advance(time);
    return {...run.sample(), nodes: run.cell.nodes, steps: run.cell.steps};
  });
  return {seen, status: run.status, ended: run.ended, draw: [...$random.uniform(setup.seed, 8)]};
});
"""
LINKS = {
    "zigzag": "v=1&r_on=26&zeta_1=600&seed=2",
    "rotation": "v=1&r_on=24&zeta_1=540&seed=12345678901",
    "changed": "v=1&r_on=16&zeta_1=600&seed=2&changes=1,r_on:26,D:0.1;3,zeta_1:560",
    "consistent": "v=1&r_on=26&zeta_1=600&seed=3&elasticity=consistent",
    "ramps": "v=2&r_on=16&seed=2&changes=1~2.5,r_on:26,r_p:52;3,zeta_1:560;3.2~4.7,D:0.1",
}
OF_LAWS = {
    "stiffness": "v=2&r_on=26&seed=2&law=stiffness&laws.chi=0.7&changes=1~2,laws.chi:0.9",
    "catch-slip": "v=2&r_on=26&zeta_1=600&seed=2&law=catch-slip&laws.catch=5&laws.catch_force=0.7",
    "load": "v=2&r_on=26&zeta_1=600&seed=2&law=load&laws.stall=3000&laws.steepness=2.5",
    "swept-myosin": "v=2&r_on=26&zeta_1=600&seed=2&law=swept-myosin&laws.sweep=0.2",
}
GROUND = (
    "v=2&r_on=26&zeta_1=600&seed=1&islands=0,0,3;1,1,1,2.2;2,0,1,1,3.1&pillars=2.2,0,0.5,0.7"
    "&pokes=push,2,0.9,0;release,3,0,0.9"
)
SOFT_GROUND = GROUND + "&law=stiffness&laws.chi=0.8"
TIMES = [0.0, 0.5, 2.0, 5.0]


OLD_COMPILER = tuple(int(part) for part in numba.__version__.split(".")[:2]) < (0, 65)


def same(value: float) -> object:
    """The same bits, but for compilers older than those that the module is built by."""
    return pytest.approx(value, rel=1e-9, abs=1e-9) if OLD_COMPILER else value


def in_node(runs: list[dict], folder: Path, module: Path | None = None) -> list[dict]:
    place = module or Path(str(resources.files("cellcrawl.explorer").joinpath(MODULE)))
    return node.run("link", content(), CODE, {"module": str(place), "runs": runs}, folder)


def slow(link: str) -> object:
    """Kernels for a law or a ground are compiled first, which takes most of a minute."""
    return pytest.param([link], marks=pytest.mark.slow)


@pytest.mark.parametrize(
    "some",
    [[*LINKS.values()], [OF_LAWS["stiffness"]], *map(slow, [*OF_LAWS.values()][1:]), slow(GROUND),
     slow(SOFT_GROUND)],
    ids=["paper", *OF_LAWS, "ground", "soft-ground"],
)  # fmt: skip
@node.needs_node
def test_the_module_computes_the_bits_of_python(tmp_path, some):
    found = in_node([{"link": link, "times": TIMES} for link in some], tmp_path)
    for link, got in zip(some, found, strict=True):
        asked = links.read(link)
        draw = np.random.default_rng(asked.seed).uniform(-1.0, 1.0, 8)
        assert got["draw"] == draw.tolist()
        run = cc.simulate(asked.parameters, t_end=TIMES[-1], **asked.options())
        for seen in got["seen"]:
            known = run.sel(time=seen["time"], method="nearest")
            for name in ("length", "tension", "area"):
                assert seen[name] == same(float(known[name])), (link, name)
            for axis in "xy":
                assert seen[axis] == same(float(known[f"centroid_{axis}"])), (link, axis)


def test_the_page_has_every_law_that_is_shipped():
    assert set(OF_LAWS) | {"paper"} == set(cc.laws.SHIPPED) == set(content()["laws"])


@node.needs_node
def test_the_page_refuses_what_the_package_refuses(tmp_path):
    asked = [
        "v=2&law=swept-myosin&laws.sweep=1.99",
        "v=2&law=catch-slip&laws.catch=5&laws.slip=0",
    ]
    found = in_node([{"link": link, "times": [0.0]} for link in asked], tmp_path)
    for link, got in zip(asked, found, strict=True):
        linked = links.read(link)
        with pytest.raises(cc.InputError) as refused:
            cc.simulate(linked.parameters, t_end=0.1, **linked.options())
        wanted = "refused" if "sweep" in str(refused.value) else "no_rest"
        assert got["status"] == wanted, (link, str(refused.value))


@node.needs_node
def test_a_run_leaves_the_model_as_it_does_in_python(tmp_path):
    link = "v=1&r_on=16&zeta_1=600&seed=9"
    asked = links.read(link)
    run = cc.simulate(asked.parameters, t_end=5.0, **asked.options())
    (got,) = in_node([{"link": link, "times": [5.0]}], tmp_path)
    assert got["status"] == run.attrs["status"] == "out_of_range"
    assert got["ended"] == pytest.approx(run.attrs["end_time"], abs=1e-6)


def test_the_shipped_module_asks_a_page_for_memory_and_stack_only():
    assert set(imports(shipped_module())) == {"env.__linear_memory", "env.__stack_pointer"}


def test_the_shipped_module_was_built_from_these_kernels():
    kept = resources.files("cellcrawl.explorer").joinpath(sources.FILE).read_text("utf-8")
    assert kept.strip() == sources.digest(), "run python -m cellcrawl.explorer.build"


@pytest.mark.slow
@node.needs_node
def test_a_fresh_build_computes_the_same_bits(tmp_path):
    from cellcrawl.explorer.module import build

    (tmp_path / "fresh.wasm").write_bytes(build())
    asked = [
        {"link": link, "times": TIMES} for link in [*LINKS.values(), *OF_LAWS.values(), GROUND]
    ]
    assert in_node(asked, tmp_path) == in_node(asked, tmp_path, tmp_path / "fresh.wasm")
