"""The solver's kernels as a WebAssembly module, by Numba and llvmlite alone.

Numba makes unoptimised text for a machine without extras (`emit`); this retargets it, links the
runtime and the C library's functions, optimises for WebAssembly and adds the exports. The module's
bytes go with Numba's version, the bits it computes do not.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, Final

import llvmlite.binding as llvm

from cellcrawl.errors import InputError
from cellcrawl.explorer import libm, object_file
from cellcrawl.explorer.runtime import RUNTIME

_TRIPLE: Final = "wasm32-unknown-unknown"
_FEATURES: Final = "+bulk-memory,+mutable-globals,+sign-ext,+nontrapping-fptoint,+simd128"
_OLDEST_LLVM: Final = 20  # older ones cannot read the runtime's text
IMPORTS: Final = frozenset({"env.__linear_memory", "env.__stack_pointer"})
"""What a page must give: the memory and where the stack begins."""


def build() -> bytes:
    """Return the module.

    Raises
    ------
    InputError
        If llvmlite is too old.
    """
    if llvm.llvm_version_info[0] < _OLDEST_LLVM:
        raise InputError(
            f"llvmlite {'.'.join(map(str, llvm.llvm_version_info))} is too old to build the "
            "browser's module: install numba 0.65 or newer"
        )
    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    with tempfile.TemporaryDirectory() as folder:
        names = _emit(Path(folder))
        machine = llvm.Target.from_triple(_TRIPLE).create_target_machine(
            cpu="generic", features=_FEATURES, opt=3, reloc="static", codemodel="default"
        )
        linked = _linked(Path(folder), names, machine)
    exported = [name for name in names if not name.startswith("libm_")] + ["heap"]
    _optimise(linked, machine)
    made = object_file.with_exports(machine.emit_object(linked), exported)
    missing = set(object_file.imports(made)) - IMPORTS
    if missing:
        raise RuntimeError(f"the module asks for what no page has: {', '.join(sorted(missing))}")
    return made


def _emit(folder: Path) -> dict[str, str]:
    """Return Numba's names of the entry points; their texts are in ``folder``."""
    settings = {
        "NUMBA_OPT": "0",
        "NUMBA_LOOP_VECTORIZE": "0",
        "NUMBA_SLP_VECTORIZE": "0",
        "NUMBA_CPU_NAME": "generic",
        "NUMBA_CPU_FEATURES": "",
        "NUMBA_CACHE_DIR": str(folder / "cache"),
        "PYTHONHASHSEED": "0",
        "PYTHONWARNINGS": "ignore",
    }
    done = subprocess.run(
        [sys.executable, "-m", "cellcrawl.explorer.emit", str(folder)],
        env={**os.environ, **settings},
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode:
        raise RuntimeError(f"the kernels do not compile:\n{done.stderr}")
    lines = (folder / "names.txt").read_text().splitlines()
    return dict(line.split(" ", 1) for line in lines)


def _retargeted(text: str, machine: Any) -> str:
    text = re.sub(r"^target triple = .*$", f'target triple = "{_TRIPLE}"', text, flags=re.M)
    layout = f'target datalayout = "{machine.target_data}"'
    text = re.sub(r"^target datalayout = .*$", layout, text, flags=re.M)
    return re.sub(r'"target-(cpu|features)"="[^"]*"', "", text)


def _linked(folder: Path, names: dict[str, str], machine: Any) -> Any:
    """Return one module of all entry points, the runtime and the C library."""
    head = f'target triple = "{_TRIPLE}"\ntarget datalayout = "{machine.target_data}"\n'
    whole = llvm.parse_assembly(head)
    for name, given in names.items():
        part = llvm.parse_assembly(_retargeted((folder / f"{name}.ll").read_text(), machine))
        entry = part.get_function(given)
        entry.name = name
        entry.linkage = llvm.Linkage.external
        whole.link_in(part)
    whole.link_in(llvm.parse_assembly(head + RUNTIME))
    whole.link_in(llvm.parse_assembly(head + _library()))
    text = str(whole)
    # an overflow check of sizes that fit in memory many times over; its product needs 128 bits
    text = re.sub(
        r"call \{ i64, i1 \} @llvm\.smul\.with\.overflow\.i64\((?:nsw )?",
        "call { i64, i1 } @plain_product(",
        text,
    )
    checked = r"^declare \{ i64, i1 \} @llvm\.smul\.with\.overflow\.i64\(.*$"
    text = re.sub(checked, _PRODUCT, text, flags=re.M)
    # calls of the C library by their own names, which LLVM knows nothing about
    library = "|".join(libm.FUNCTIONS)
    declared = rf"^declare double @(llvm\.({library})\.f64|({library}))\(.*$"
    text = re.sub(declared, "", text, flags=re.M)
    text = re.sub(rf"@(?:llvm\.)?({library})(?:\.f64)?\(", r"@cell_\1(", text)
    kept = {*names, "heap"} - {name for name in names if name.startswith("libm_")}
    whole = llvm.parse_assembly(text)
    for function in whole.functions:
        if not function.is_declaration:
            keep = function.name in kept
            function.linkage = llvm.Linkage.external if keep else llvm.Linkage.internal
    for variable in whole.global_variables:
        if not variable.is_declaration:
            variable.linkage = llvm.Linkage.internal
    whole.verify()
    return whole


_PRODUCT: Final = """define internal { i64, i1 } @plain_product(i64 %a, i64 %b) alwaysinline {
  %c = mul i64 %a, %b
  %d = insertvalue { i64, i1 } undef, i64 %c, 0
  %e = insertvalue { i64, i1 } %d, i1 false, 1
  ret { i64, i1 } %e
}"""


def _library() -> str:
    """Return the C library's functions as calls of the compiled ones."""
    texts = []
    for name, (_, count) in libm.FUNCTIONS.items():
        given = ", ".join(f"double %x{k}" for k in range(count))
        texts.append(f"""declare i32 @libm_{name}(ptr, ptr, {", ".join(["double"] * count)})
define double @cell_{name}({given}) {{
  %out = alloca double
  %error = alloca ptr
  %code = call i32 @libm_{name}(ptr %out, ptr %error, {given})
  %value = load double, ptr %out
  ret double %value
}}""")
    return "\n".join(texts)


def _optimise(module: Any, machine: Any) -> None:
    for level in (0, 3, 3):
        options = llvm.PipelineTuningOptions(speed_level=level)
        options.loop_vectorization = options.slp_vectorization = level == 3
        builder = llvm.create_pass_builder(machine, options)
        passes = builder.getModulePassManager()
        passes.add_refprune_pass()
        passes.run(module, builder)
