// Opens a replay of seed_hit_fracture in headless Chromium as a person would: node replay_test.mjs CHROMIUM REPLAY
// Fails when the page asks for the network, logs an error, or does not play, scrub and turn. With TOPPLE_REPLAY_PICTURE set, the
// last view is written there.
import { chromium } from 'playwright-core';
import { readFileSync, writeFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';

const [executablePath, replay] = process.argv.slice(2);
let failures = 0;

function check(condition, what) {
  console.log(`${condition ? 'ok' : 'FAILED'}: ${what}`);
  if (!condition) ++failures;
}

/** The canvas as a picture; waits for a frame to be drawn first. */
async function picture(page) {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  return page.locator('#canvas').screenshot();
}

async function scrub(page, time) {
  await page.locator('#time').evaluate((slider, value) => {
    slider.value = value;
    slider.dispatchEvent(new Event('input'));
  }, time);
}

const standing = async (page) => Number.parseInt(await page.locator('#state').textContent(), 10);

const browser = await chromium.launch({
  executablePath,
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist', '--disable-quic', '--no-first-run', '--disable-background-networking',
    '--disable-component-update', '--disable-sync'],
});
try {
  const context = await browser.newContext({ viewport: { width: 800, height: 500 }, offline: true });
  const page = await context.newPage();
  page.setDefaultTimeout(120000);
  const complaints = [], requests = [];
  page.on('console', (message) => message.type() === 'error' && complaints.push(message.text()));
  page.on('pageerror', (error) => complaints.push(String(error)));
  page.on('request', (request) => !/^(file|data|blob):/.test(request.url()) && requests.push(request.url()));
  await page.goto(pathToFileURL(replay).href);
  await page.waitForSelector('body[data-ready]', { state: 'attached' });
  const whole = await standing(page), start = await picture(page);
  check(whole > 300, `all of the building stands at first (${whole})`);
  await scrub(page, 3.9);
  const fallen = await picture(page);
  check((await standing(page)) < whole, 'after the hit less of it stands');
  check(!start.equals(fallen), 'scrubbing changes the picture');
  check((await page.locator('#event').textContent()) !== '' || (await page.locator('#marks i').count()) > 0, 'events are told');
  await scrub(page, 0);
  check((await standing(page)) === whole && start.equals(await picture(page)), 'scrubbing back brings back the very picture');
  await page.locator('#panels').uncheck();
  check(!start.equals(await picture(page)), 'panels can be hidden');
  await page.locator('#panels').check();
  await page.mouse.move(400, 200);
  await page.mouse.down();
  await page.mouse.move(520, 220, { steps: 4 });
  await page.mouse.up();
  check(!start.equals(await picture(page)), 'dragging turns the view');
  await page.locator('#play').click();
  // Stopped within the page: where drawing is slow the end may come before a click from outside does.
  const stopped = await page.waitForFunction(() => {
    const clock = Number.parseFloat(document.getElementById('clock').textContent), play = document.getElementById('play');
    if (!(clock > 0.2)) return null;
    if (play.textContent !== 'Play') play.click();
    return document.getElementById('clock').textContent;
  });
  const at = await stopped.jsonValue();
  await picture(page);
  check((await page.locator('#play').textContent()) === 'Play', 'it plays and stops');
  check((await page.locator('#clock').textContent()) === at, 'it stands still where it was stopped');
  // The same page without the weights of its bends: what bends is drawn straight there.
  const stiff = await context.newPage(), without = replay.replace(/\.html$/, '-stiff.html');
  writeFileSync(without, readFileSync(replay, 'utf8').replaceAll('"weights":', '"unused":'));
  await stiff.goto(pathToFileURL(without).href);
  await stiff.waitForSelector('body[data-ready]', { state: 'attached' });
  const again = await context.newPage();
  await again.goto(pathToFileURL(replay).href);
  await again.waitForSelector('body[data-ready]', { state: 'attached' });
  const shown = async (one) => {
    await one.bringToFront();
    await scrub(one, 3.9);
    return picture(one);
  };
  check(fallen.equals(await shown(again)), 'a page opened again shows the same');
  check(!fallen.equals(await shown(stiff)), 'members and panels are drawn bent');
  await page.bringToFront();
  await scrub(page, 2.5);
  await picture(page);
  check(complaints.length === 0, `no console errors ${complaints.join('; ')}`);
  check(requests.length === 0, `no request to the network ${requests.join(' ')}`);
  if (process.env.TOPPLE_REPLAY_PICTURE) await page.screenshot({ path: process.env.TOPPLE_REPLAY_PICTURE });
} finally {
  await browser.close();
}
process.exit(failures ? 1 : 0);
