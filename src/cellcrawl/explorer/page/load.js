// The compiled solver, which the page carries in itself.

export async function loadModule() {
  if (typeof WebAssembly !== "object") throw new Error("This browser has no WebAssembly, in which the solver is compiled.");
  if (typeof DecompressionStream !== "function") throw new Error("This browser cannot unpack the solver.");
  const text = document.getElementById("module").textContent.trim();
  const packed = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  const bytes = await new Response(stream).arrayBuffer();
  if (!WebAssembly.validate(bytes)) throw new Error("This browser's WebAssembly has no SIMD part, which the solver uses.");
  return WebAssembly.compile(bytes);
}
