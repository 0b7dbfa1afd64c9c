// node view.mjs DIR [NAME [PICTURE]]: opens tileset NAME of DIR, plain and compressed, in 3d-tiles-renderer (three.js) in
// Debian's Chromium. It must stand in Delft, load coarse tiles from afar and fine ones from near, and a click must tell
// building and class by feature ids and property tables. PICTURE: where the picture goes.
import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { dirname, extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';

const here = dirname(fileURLToPath(import.meta.url));
const [folder, name = 'footprints', picture] = process.argv.slice(2);
const types = { '.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.json': 'application/json' };

/** This folder, and a tileset as "samples/". */
function serve(tileset) {
  const server = createServer((request, response) => {
    const path = normalize(decodeURIComponent(new URL(request.url, 'http://x').pathname)).replace(/^(\.\.[/\\])+/, '');
    try {
      const file = path.startsWith('/samples/') ? join(folder, tileset, path.slice(9)) : join(here, path);
      const bytes = readFileSync(file);
      response.writeHead(200, { 'Content-Type': types[extname(file)] ?? 'application/octet-stream' }).end(bytes);
    } catch {
      response.writeHead(404).end();
    }
  });
  return new Promise((resolve) => server.listen(0, '127.0.0.1', () => resolve(server)));
}

async function view(browser, tileset) {
  const server = await serve(tileset);
  const page = await browser.newPage({ viewport: { width: 1200, height: 720 } });
  const complaints = [];
  page.on('pageerror', (error) => complaints.push(String(error)));
  page.on('console', (message) => { if (message.type() === 'error') complaints.push(message.text()); });
  await page.goto(`http://127.0.0.1:${server.address().port}/view.html`);
  await page.waitForFunction(() => window.viewer, null, { timeout: 60_000 }).catch(() => {
    throw new Error(`the page does not start: ${complaints.join('; ')}`);
  });
  const place = await page.evaluate(() => window.viewer.place);
  assert(Math.abs(place.lat - 52.01) < 0.03 && Math.abs(place.lon - 4.36) < 0.03, `not in Delft: ${JSON.stringify(place)}`);
  assert(Math.abs(place.height) < 60, `not on the ground: ${place.height} m`);
  const seen = await page.evaluate(async () => {
    const all = [];
    for (const [distance, height] of [[40, 30], [1.1, 1.1]]) {
      window.viewer.look(distance, height);
      await window.viewer.settle();
      const picks = [];
      for (let v = 0.02; v < 1; v += 0.04) for (let u = 0.02; u < 1; u += 0.04) picks.push(window.viewer.pick(u, v));
      all.push({ loaded: window.viewer.loaded(), picks: picks.filter(Boolean) });
    }
    return all;
  });
  if (picture && !tileset.endsWith('-compressed')) writeFileSync(picture, await page.screenshot());
  assert.deepEqual(await page.evaluate(() => window.viewer.failures), []);
  assert.deepEqual(complaints.filter((text) => !/favicon|404/.test(text)), []);
  await page.close();
  server.close();
  return seen;
}

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
  args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--no-first-run',
    '--disable-background-networking', '--disable-component-update', '--disable-sync'],
});
const footprints = JSON.parse(readFileSync(join(folder, 'expected.json'), 'utf8'))[name];
try {
  for (const tileset of [name, `${name}-compressed`]) {
    const [far, near] = await view(browser, tileset);
    assert(near.loaded > far.loaded, 'no finer tiles are loaded from near');
    assert(near.picks.length > 30, `only ${near.picks.length} clicks met something`);
    for (const { part, surface, material, normal } of near.picks) {
      assert(part.building_id && part.part_id.startsWith(part.building_id), JSON.stringify(part));
      assert.equal(surface.class, material);
      assert(Math.abs(normal[1] - Math.cos(surface.slope * Math.PI / 180)) < 0.02, `${surface.slope}° looks to ${normal}`);
    }
    const buildings = new Set(near.picks.map((p) => p.part.building_id)), classes = new Set(near.picks.map((p) => p.surface.class));
    assert(buildings.size > footprints.buildings / 8 && buildings.size <= footprints.buildings, `${buildings.size} buildings`);
    assert(classes.has('roof') && classes.has('wall'), [...classes].join());
    console.log(`${tileset}: ${far.loaded} tiles from afar, ${near.loaded} from near; ${near.picks.length} clicks met ` +
      `${buildings.size} of ${footprints.buildings} buildings; the first: ${near.picks[0].part.part_id}, ${near.picks[0].surface.class}`);
  }
} finally {
  await browser.close();
}
