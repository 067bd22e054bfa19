// Inverse of packing.py: base64 of deflated byte planes, the first bytes of all numbers before the second ones.
async function unpackBytes(id, width) {
  const text = atob(document.getElementById(id).textContent);
  const deflated = Uint8Array.from(text, letter => letter.charCodeAt(0));
  const stream = new Blob([deflated]).stream().pipeThrough(new DecompressionStream("deflate"));
  const planes = new Uint8Array(await new Response(stream).arrayBuffer());
  const count = planes.length / width;
  const bytes = new Uint8Array(planes.length);
  for (let i = 0; i < count; i++) for (let k = 0; k < width; k++) bytes[i * width + k] = planes[k * count + i];
  return bytes;
}

// Half precision (IEEE 754 binary16), decoded with a table.
async function unpackHalves(id) {
  const decode = code => {
    const [sign, exponent, fraction] = [code >> 15 ? -1 : 1, (code >> 10) & 31, code & 1023];
    return sign * (exponent ? 2 ** (exponent - 15) * (1 + fraction / 1024) : 2 ** -24 * fraction);
  };
  const table = Float32Array.from({ length: 65536 }, (_, code) => decode(code));
  const bytes = await unpackBytes(id, 2);
  const view = new DataView(bytes.buffer);
  return Float32Array.from({ length: bytes.length / 2 }, (_, i) => table[view.getUint16(2 * i, true)]);
}
