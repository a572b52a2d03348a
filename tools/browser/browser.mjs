// Runs Debian's Chromium without a window and loads the page. WebGL 2 runs in software, on SwiftShader.

import { existsSync } from 'node:fs';
import { chromium } from 'playwright-core';

const EXECUTABLE = process.env.CHROMIUM ?? '/usr/bin/chromium';

// Chromium's warning that reading back pixels stalls.
const EXPECTED = /GPU stall due to ReadPixels/;

/**
 * Starts the browser. Resolves to `{ open, close }`: `open(url)` resolves to `{ page, complaints }`, playwright's page and what the browser
 * has logged of it so far.
 */
export async function openBrowser() {
  if (!existsSync(EXECUTABLE)) throw new Error(`${EXECUTABLE} is missing: apt-get install chromium, or name another in CHROMIUM`);
  // Chromium's own sandbox refuses to run as root and in most containers. The pages are ours, and they load nothing from elsewhere.
  const browser = await chromium.launch({ executablePath: EXECUTABLE, args: ['--no-sandbox', '--enable-unsafe-swiftshader'] });
  const open = async (url) => {
    const page = await browser.newPage();
    const messages = [];
    page.on('console', (message) => EXPECTED.test(message.text()) || messages.push(message.text()));
    page.on('pageerror', (error) => messages.push(String(error)));
    page.on('requestfailed', (request) => messages.push(`${request.url()}: ${request.failure()?.errorText}`));
    page.on('response', (response) => response.ok() || messages.push(`${response.url()}: ${response.status()}`));
    await page.goto(url);
    return { page, complaints: () => messages };
  };
  return { open, close: () => browser.close() };
}

/**
 * Opens the page of three.js. Resolves to `{ draw, complaints, close }`: `draw(job)` resolves to the RGBA floats of page/draw.js,
 * `complaints()` is what the browser has logged.
 */
export async function openPage(url) {
  const browser = await openBrowser();
  let page;
  let complaints;
  try {
    ({ page, complaints } = await browser.open(url));
    await page.waitForFunction(() => window.draw, null, { timeout: 20_000 }).catch(() => {
      throw new Error(`the page did not start:\n${complaints().join('\n')}`);
    });
  } catch (error) {
    // An open browser would keep the process alive.
    await browser.close();
    throw error;
  }
  const draw = async (job) => {
    try {
      const text = await page.evaluate((job) => window.draw(job), job);
      const bytes = Buffer.from(text, 'base64');
      return new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
    } catch (error) {
      throw new Error(`${error.message}\n${complaints().join('\n')}`);
    }
  };
  return { draw, complaints, close: browser.close };
}
