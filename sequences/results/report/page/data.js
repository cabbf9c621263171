// What do the packed columns hold? The way back of results/report/packed_column.h: deflated planes of bytes, each row
// XORed with the one before of its series. Columns are unpacked when they are asked for.

const kBlock = 4096;

async function inflated(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Indices of words: 4 bytes a row.
function unpackedWords(planes, rows, series) {
  const out = new Uint32Array(rows), before = new Uint32Array(seriesCount(series));
  for (let start = 0; start < rows; start += kBlock) {
    const n = Math.min(kBlock, rows - start), p = start * 4;
    for (let i = 0; i < n; ++i) {
      const bits = planes[p + i] | (planes[p + n + i] << 8) | (planes[p + 2 * n + i] << 16) | (planes[p + 3 * n + i] << 24);
      const s = series ? series[start + i] : 0;
      out[start + i] = before[s] ^= bits;
    }
  }
  return out;
}

// Doubles: 8 bytes a row.
function unpackedNumbers(planes, rows, series) {
  const out = new Uint32Array(2 * rows), count = seriesCount(series);
  const low = new Uint32Array(count), high = new Uint32Array(count);
  for (let start = 0; start < rows; start += kBlock) {
    const n = Math.min(kBlock, rows - start), p = start * 8;
    for (let i = 0; i < n; ++i) {
      const q = p + i, s = series ? series[start + i] : 0;
      low[s] ^= planes[q] | (planes[q + n] << 8) | (planes[q + 2 * n] << 16) | (planes[q + 3 * n] << 24);
      high[s] ^= planes[q + 4 * n] | (planes[q + 5 * n] << 8) | (planes[q + 6 * n] << 16) | (planes[q + 7 * n] << 24);
      out[2 * (start + i)] = low[s];
      out[2 * (start + i) + 1] = high[s];
    }
  }
  return new Float64Array(out.buffer);
}

function seriesCount(series) {
  let count = 1;
  if (series) for (const s of series) if (s >= count) count = s + 1;
  return count;
}

// A table of the results: columns by name, rows by number.
class Table {
  constructor(json, seriesName) {
    this.rows = json.rows;
    this.seriesName = seriesName;
    this.columns = new Map(json.columns.map((column) => [column.name, column]));
    this.loaded = false;
  }
  has(name) {
    const column = this.columns.get(name);
    return column !== undefined && column.data !== undefined;
  }
  // Unpacks the columns that are there; the others stay empty.
  async need(names) {
    let series = null;
    if (this.seriesName && this.has(this.seriesName)) series = (await this.unpack(this.seriesName, null)).values;
    await Promise.all(names.filter((name) => this.has(name)).map((name) => this.unpack(name, series)));
  }
  unpack(name, series) {
    const column = this.columns.get(name);
    column.loading ??= (async () => {
      const element = document.getElementById(column.data);
      const planes = await inflated(element.textContent);
      column.values = column.words ? unpackedWords(planes, this.rows, name === this.seriesName ? null : series)
                                   : unpackedNumbers(planes, this.rows, series);
      element.remove();
      return column;
    })();
    return column.loading;
  }
  // All columns, one after the other, so that the page stays awake.
  async needAll() {
    for (const name of this.columns.keys()) {
      await this.need([name]);
      await new Promise((done) => setTimeout(done));
    }
    this.loaded = true;
  }
  // A number, a text, or null.
  value(name, row) {
    const column = this.columns.get(name);
    if (column === undefined || column.values === undefined || row < 0) return null;
    const value = column.values[row];
    if (column.words) return value === 0 ? null : this.wordAt(column, value, row);
    return Number.isNaN(value) ? null : value;
  }
  wordAt(column, index, row) {
    const word = column.words[index];
    if (!column.numbers || !word.includes("\u0001")) return word;
    return word.replace(/\u0001([a-z])/g, (mark, letter) => {
      const value = this.value(column.numbers[letter.charCodeAt(0) - 97], row);
      return value === null ? "…" : String(Number(value.toPrecision(4)));
    });
  }
}
