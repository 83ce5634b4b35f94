// A page whose program was updated meanwhile: version_test.mjs PROGRAM SOURCE PACKAGES SESSIONS PICTURES
import assert from "node:assert/strict";
import { readFileSync, rmSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { leave, makeFolder, openStudio, overflow, paths, picture, seriousFindings } from "./browser.mjs";

test("a page of another version says so, and goes on when it is loaded again", async () => {
  const written = /`ctpm\.studio\.(\d+)`/.exec(readFileSync(join(paths.source, "studio", "server", "PROTOCOL.md"), "utf8"))[1];
  const folder = makeFolder("kidney.json"), studio = await openStudio(folder), { page } = studio;
  // The page as it was before: it speaks version 1, the first time that it is loaded.
  await page.addInitScript(() => {
    if (sessionStorage.getItem("loaded")) return;
    sessionStorage.setItem("loaded", "yes");
    globalThis.offered = [];
    globalThis.WebSocket = class extends WebSocket {
      constructor(address, [protocol, token]) {
        globalThis.offered.push(protocol);
        super(address, ["ctpm.studio.1", token]);
      }
    };
  });
  await page.reload();
  await page.waitForSelector(".empty:has-text('The program was updated')");
  assert.deepEqual(await page.evaluate(() => globalThis.offered), [`ctpm.studio.${written}`]);
  assert.match(await page.locator(".empty").innerText(), new RegExp(`speaks version ${written} of the protocol, its client version 1`));
  assert.deepEqual(await seriousFindings(page), []);
  assert.ok((await overflow(page)) <= 0);
  await picture(page, "version");
  await page.waitForTimeout(2500); // longer than a page waits that looks for its program
  assert.equal(await page.evaluate(() => globalThis.offered.length), 1, "it does not ask on and on");
  await page.click(".empty button:has-text('Load the page again')");
  await page.waitForSelector(".scenes button:has-text('kidney')");
  assert.deepEqual(studio.complaints, []);
  assert.equal(await studio.close(), 0);
  rmSync(folder, { recursive: true });
});

test("a page goes on, in its room, where the address of the program's next run is opened in it", async () => {
  const folder = makeFolder("kidney.json"), studio = await openStudio(folder), { page } = studio;
  await page.click("header nav button:has-text('Train')");
  await studio.kill();
  await page.waitForSelector(".empty:has-text('The studio has ended')");
  await page.goto(await studio.startAgain());
  await page.waitForSelector(".room.train");
  assert.ok(!page.url().includes("token"));
  await leave(studio, folder);
});
