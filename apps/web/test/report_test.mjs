// Opens reports in headless Chromium as a person would: node report_test.mjs CHROMIUM REPORT...
// Fails when a page asks for the network, logs an error, does not turn, or does not switch results. With
// TOPPLE_REPORT_PICTURE set, the last view is written there.
import { chromium } from 'playwright-core';
import { pathToFileURL } from 'node:url';

const [executablePath, ...reports] = process.argv.slice(2);
let failures = 0;

function check(condition, what) {
  console.log(`${condition ? 'ok' : 'FAILED'}: ${what}`);
  if (!condition) ++failures;
}

async function turn(page) {
  const box = await page.locator('#canvas').boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 140, y + 30, { steps: 6 });
  await page.mouse.up();
}

/** The canvas as a picture; waits for a frame to be drawn first. */
async function picture(page) {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  return page.locator('#canvas').screenshot();
}

async function open(browser, report) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, offline: true });
  const page = await context.newPage();
  page.setDefaultTimeout(120000);
  const complaints = [], requests = [];
  page.on('console', (message) => message.type() === 'error' && complaints.push(message.text()));
  page.on('pageerror', (error) => complaints.push(String(error)));
  page.on('request', (request) => !request.url().startsWith('file:') && !request.url().startsWith('data:') && requests.push(request.url()));
  const started = Date.now();
  await page.goto(pathToFileURL(report).href);
  const shown = page.waitForFunction(() => document.querySelectorAll('#tabs button').length > 0, null, { timeout: 60000 });
  await Promise.race([shown, new Promise((_, fail) => page.on('pageerror', fail))]);
  console.log(`${report}: open after ${Date.now() - started} ms`);
  return { page, complaints, requests };
}

async function exercise(browser, report) {
  const { page, complaints, requests } = await open(browser, report);
  const before = await picture(page);
  await turn(page);
  const turned = await picture(page);
  check(!before.equals(turned), 'dragging turns the view');

  await page.selectOption('#choose-diagram', 'moment_y');
  check(!turned.equals(await picture(page)), 'a force diagram is drawn');
  await page.selectOption('#choose-colour', 'axial');
  const plain = await picture(page);
  await page.locator('#scale').fill('4');
  check(!plain.equals(await picture(page)), 'the scale changes the deformed shape');
  const combinations = await page.locator('#choose-combination option').allTextContents();
  if (combinations.length > 1) {
    await page.selectOption('#choose-combination', combinations[1]);
    check((await page.locator('#summary').textContent()).includes(combinations[1]), 'another combination is shown');
  }

  await page.locator('#tabs button[data-table=displacements]').click();
  const first = () => page.locator('#table tbody tr').first().textContent();
  const unsorted = await first();
  await page.locator('#table th').nth(3).click();
  const largest = await first();
  await page.locator('#table th').nth(3).click();
  check((await first()) !== largest || unsorted !== largest, 'a table sorts');
  const all = await page.locator('#rowcount').textContent();
  const name = (await page.locator('#table tbody tr td').first().textContent());
  await page.fill('#filter', name);
  check((await page.locator('#table tbody tr').count()) >= 1 && (await page.locator('#rowcount').textContent()) !== all, 'a table filters');
  check((await page.locator('#table th .unit').nth(1).textContent()).trim() !== '' , 'columns name their units');
  const checks = page.locator('#tabs button[data-table=design]');
  if (await checks.count()) {
    await page.fill('#filter', '');
    await checks.click();
    check((await page.locator('#table tbody tr').first().textContent()).includes('AISC 360'), 'design checks name their clauses');
  }
  check(complaints.length === 0, `no console errors ${complaints.join('; ')}`);
  check(requests.length === 0, `no request to the network ${requests.join(' ')}`);
  if (process.env.TOPPLE_REPORT_PICTURE) await page.screenshot({ path: process.env.TOPPLE_REPORT_PICTURE, fullPage: true });
  await page.context().close();
}

/** What is printed: a summary first, numbers with units that a person reads, no column beyond the sheet. */
async function printed(browser, report) {
  const context = await browser.newContext({ viewport: { width: 674, height: 900 }, offline: true });  // A4 less its margins
  const page = await context.newPage();
  page.setDefaultTimeout(120000);
  await page.emulateMedia({ media: 'print' });
  await page.goto(`${pathToFileURL(report).href}#print`);
  await page.waitForFunction(() => document.querySelectorAll('#paper .chapter').length > 3, null, { timeout: 60000 });
  const found = await page.evaluate(() => ({
    chapters: [...document.querySelectorAll('#paper h2')].map((h) => h.textContent),
    text: document.getElementById('paper').textContent,
    si: document.getElementById('data').textContent.includes('"force":"N"'),
    beyond: [...document.querySelectorAll('#paper table, #paper svg')].filter((e) => e.getBoundingClientRect().right > document.getElementById('paper').getBoundingClientRect().right + 1).length,
  }));
  check(found.chapters[1] === '1. Summary', 'paper begins with a summary');
  check(!/undefined|NaN|\[object/.test(found.text), 'no cell of the paper is without a value');
  check(!found.si || (found.text.includes('kNm') && !found.text.includes('N m,')), 'forces are printed in kN and kNm');
  check(found.beyond === 0, 'no table or drawing goes beyond the sheet');
  await context.close();
}

const browser = await chromium.launch({
  executablePath,
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist', '--disable-quic', '--no-first-run', '--disable-background-networking',
    '--disable-component-update', '--disable-sync'],
});
try {
  for (const report of reports) {
    await exercise(browser, report);
    await printed(browser, report);
  }
} finally {
  await browser.close();
}
process.exit(failures ? 1 : 0);
