// Makes the KTX2 files and their reference decodings. npm i ktx2-encoder@0.6.0; node make.mjs OUT
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
for (const [name, f] of Object.entries(pics)) for (const kind of ['etc1s']) {
  const [w, h] = sizes[name]; state = 7; const px = new Uint8Array(w * h * 4);
  for (let y = 0; y < h; ++y) for (let x = 0; x < w; ++x) px.set(f(x, y, w, h).map(v => v & 255), 4 * (y * w + x));
  const e = new M.BasisEncoder(); const b = new Uint8Array(1 << 20);
  e.setSliceSourceImage(0, px, w, h, 0); e.setCreateKTX2File(true); e.setUASTC(kind === 'uastc');
  e.setKTX2UASTCSupercompression(false); if (e.setKTX2AndBasisSRGBTransferFunc) e.setKTX2AndBasisSRGBTransferFunc(true);
  e.setPackUASTCFlags(name === 'gradient' ? 2 : 4); e.setQualityLevel(200);
  const n = e.encode(b); e.delete(); const bytes = b.slice(0, n);
  const k = new M.KTX2File(bytes); if (!n || !k.isValid()) throw name + kind; k.startTranscoding();
  const args = [0, 0, 0, 13]; const size = k.getImageTranscodedSizeInBytes(...args); const d = new Uint8Array(size);
  const r = k.transcodeImageWithFlags(d, 0, 0, 0, 13, 0, -1, -1); if (!r) throw 'transcode'; k.close(); k.delete();
  fs.writeFileSync(`${out}/${kind}_${name}.ktx2`, bytes); fs.writeFileSync(`${out}/${kind}_${name}.rgba`, d);
  console.log(kind, name, n, size, w * h * 4);
}
