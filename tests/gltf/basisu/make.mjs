// Makes the KTX2 files of both kinds and their reference decodings. npm i ktx2-encoder@0.6.0; node make.mjs OUT
import fs from 'fs'; import path from 'path'; import { createRequire } from 'module';
const out = process.argv[2]; const require = createRequire(import.meta.url);
const dir = path.resolve('node_modules/ktx2-encoder/dist/basis');
const BASIS = (await import(dir + '/basis_encoder.js')).default ?? require(dir + '/basis_encoder.js');
const M = await BASIS({ wasmBinary: fs.readFileSync(dir + '/basis_encoder.wasm') });
M.initializeBasis();
let state = 1; const rnd = () => (state = (Math.imul(state, 1664525) + 1013904223) >>> 0) >>> 24;
const pics = {
  gradient: (x, y, w, h) => [255 * x / w, 255 * y / h, 128, 255],
  noise: () => [rnd(), rnd(), rnd(), 255],
  noise_alpha: () => [rnd(), rnd(), rnd(), rnd()],
  disk: (x, y, w, h) => { const r = Math.hypot(x - w / 2, y - h / 2); return [220, 40 + 3 * x, 30, r < w / 3 ? 255 : 0]; },
  solid: () => [12, 200, 77, 130],
  gray: (x, y, w) => { const v = 255 * x / w ^ (y * 5); return [v, v, v, 255]; },
  gray_alpha: (x, y, w) => { const v = 255 * x / w; return [v, v, v, (y * 9 + rnd() / 8) & 255]; },
  edges: (x, y) => ((x * 3 + y * 2) % 11 < 5 ? [230, 20, 30, 255] : (x + y) % 7 < 3 ? [10, 90, 240, 255] : [20, 220, 60, 255]),
  edges_alpha: (x, y) => ((x * 3 + y * 2) % 11 < 5 ? [230, 20, 30, 255] : (x + y) % 7 < 3 ? [10, 90, 240, 60] : [20, 220, 60, 128]),
};
const sizes = { gradient: [32, 32], noise: [16, 16], noise_alpha: [17, 13], disk: [33, 30], solid: [5, 3], gray: [32, 16], gray_alpha: [16, 32], edges: [31, 29], edges_alpha: [24, 24] };

function draw(name) {
  const [w, h] = sizes[name]; state = 7; const px = new Uint8Array(w * h * 4);
  for (let y = 0; y < h; ++y) for (let x = 0; x < w; ++x) px.set(pics[name](x, y, w, h).map(v => v & 255), 4 * (y * w + x));
  return px;
}

function encode(name, isUastc, isPacked) {
  const e = new M.BasisEncoder(); const b = new Uint8Array(1 << 20);
  e.setSliceSourceImage(0, draw(name), ...sizes[name], 0); e.setCreateKTX2File(true); e.setUASTC(isUastc);
  e.setKTX2UASTCSupercompression(isPacked); if (e.setKTX2AndBasisSRGBTransferFunc) e.setKTX2AndBasisSRGBTransferFunc(true);
  e.setPackUASTCFlags(name === 'gradient' ? 2 : 4); e.setQualityLevel(200);
  const n = e.encode(b); e.delete(); if (!n) throw name;
  return b.slice(0, n);
}

function write(name, bytes) {
  const k = new M.KTX2File(bytes); if (!k.isValid()) throw name; k.startTranscoding();
  const d = new Uint8Array(k.getImageTranscodedSizeInBytes(0, 0, 0, 13));
  if (!k.transcodeImageWithFlags(d, 0, 0, 0, 13, 0, -1, -1)) throw 'transcode ' + name; k.close(); k.delete();
  fs.writeFileSync(`${out}/${name}.ktx2`, bytes); fs.writeFileSync(`${out}/${name}.rgba`, d);
  console.log(name, bytes.length, d.length);
}

// UASTC blocks by hand, since no picture makes the encoder choose everything: of each mode, and there
// of each pattern and each channel of the second plane, the rest of the bits by chance. A mode: its
// code, the code's bits, the bits of hints, what then comes (how many bits of it, how many values).
const modes = [[0x01, 4, 15], [0x35, 6, 15], [0x1d, 5, 15, 5, 30], [0x03, 5, 15, 4, 11], [0x13, 5, 15, 5, 30],
  [0x0b, 5, 15], [0x1b, 5, 15, 2, 4], [0x07, 5, 15, 5, 19], [0x17, 5, 0], [0x0f, 5, 23, 5, 30], [0x02, 3, 17],
  [0x00, 2, 17, 2, 4], [0x06, 3, 17], [0x1f, 5, 23, 2, 4], [0x0d, 5, 23], [0x05, 7, 23], [0x15, 6, 23, 5, 30],
  [0x25, 6, 23], [0x09, 4, 15]];
function putBits(block, at, count, value) {
  for (let i = 0; i < count; ++i, ++at) block[at >> 3] = block[at >> 3] & ~(1 << (at & 7)) | (value >> i & 1) << (at & 7);
}
function makeBlocks(level) {
  state = 7; let at = 0;
  for (const [code, codeBits, hintBits, bits = 0, values = 1] of modes) for (let i = 0; i < Math.max(values, 8); ++i) {
    const block = level.subarray(at, at += 16).fill(0).map(rnd);
    putBits(block, 0, codeBits, code); putBits(block, codeBits + hintBits, bits, i % values);
    level.set(block, at - 16);
  }
  if (at > level.length) throw 'blocks';
}

for (const name of Object.keys(pics)) { write('etc1s_' + name, encode(name, false, false)); write('uastc_' + name, encode(name, true, false)); }
write('uastc_zstd', encode('disk', true, true));
pics.modes = () => [1, 2, 3, 4]; sizes.modes = [64, 64];
const file = encode('modes', true, false); const view = new DataView(file.buffer);
makeBlocks(file.subarray(Number(view.getBigUint64(80, true)))); write('uastc_modes', file);
