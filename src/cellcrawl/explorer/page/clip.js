// A clip of what is drawn, recorded by the browser: each picture is a frame.

import { save } from "./take.js";

const LONGEST = 60; // seconds
const KINDS = ["video/mp4;codecs=avc1", "video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm", "video/mp4"];

let recorder = null;

// A picture has been drawn.
export function drawn() {
  if (!recorder) return;
  recorder.last = performance.now();
  recorder.first ??= recorder.last;
  recorder.frames += 1;
  recorder.track.requestFrame?.();
}

// Begin to record a canvas, or end it and save the clip.
export function clip(canvas, button, notice) {
  if (recorder) return recorder.stop();
  if (!canvas.captureStream || typeof MediaRecorder === "undefined") return notice("This browser cannot record a clip of a canvas.");
  const type = KINDS.find((name) => MediaRecorder.isTypeSupported(name));
  if (!type) return notice("This browser cannot record a clip.");
  const byHand = typeof CanvasCaptureMediaStreamTrack !== "undefined" && "requestFrame" in CanvasCaptureMediaStreamTrack.prototype;
  const parts = [], kept = button.textContent, stream = canvas.captureStream(byHand ? 0 : 50);
  recorder = new MediaRecorder(stream, { mimeType: type, videoBitsPerSecond: 8e6 });
  Object.assign(recorder, { track: stream.getVideoTracks()[0], frames: 0 });
  recorder.ondataavailable = (event) => event.data.size && parts.push(event.data);
  const began = performance.now();
  const ticking = setInterval(() => (button.textContent = `Stop (${Math.floor((performance.now() - began) / 1000)} s)`), 250);
  const limit = setTimeout(() => recorder?.stop(), LONGEST * 1000);
  recorder.onstop = async () => {
    clearInterval(ticking);
    clearTimeout(limit);
    button.textContent = kept;
    const { first = 0, last = 0, track } = recorder;
    track.stop();
    recorder = null;
    const bytes = new Uint8Array(await new Blob(parts).arrayBuffer()), mp4 = type.includes("mp4");
    save(new Blob([mp4 ? bytes : withDuration(bytes, last - first)], { type }), `cell.${mp4 ? "mp4" : "webm"}`);
  };
  recorder.start(1000);
  return recorder;
}

// A WebM file as browsers record it does not say how long it is; players then show no time line.
export function withDuration(bytes, milliseconds) {
  const INFO = [0x15, 0x49, 0xa9, 0x66], DURATION = [0x44, 0x89, 0x88];
  const at = bytes.findIndex((_, k) => k < 4096 && INFO.every((value, i) => bytes[k + i] === value));
  if (at < 0) return bytes;
  const size = at + INFO.length, width = Math.clz32(bytes[size]) - 23; // of the size that follows
  let length = bytes[size] & (0xff >> width);
  for (let k = 1; k < width; k++) length = length * 256 + bytes[size + k];
  const end = size + width + length, longer = length + DURATION.length + 8;
  const told = bytes.subarray(size + width, end).some((_, k, info) => info[k] === DURATION[0] && info[k + 1] === DURATION[1]);
  if (told || longer >= 2 ** (7 * width) - 1) return bytes;
  const made = new Uint8Array(bytes.length + DURATION.length + 8);
  made.set(bytes.subarray(0, end));
  for (let k = width - 1, rest = longer; k >= 0; k--, rest = Math.floor(rest / 256)) made[size + k] = rest % 256;
  made[size] |= 0x80 >> (width - 1);
  made.set(DURATION, end);
  new DataView(made.buffer).setFloat64(end + DURATION.length, milliseconds);
  made.set(bytes.subarray(end), end + DURATION.length + 8);
  return made;
}
