// A page of somebody else in the same browser, which even has the token: origin_test.mjs PROGRAM SOURCE PACKAGES SESSIONS PICTURES
import assert from "node:assert/strict";
import { existsSync, readFileSync, rmSync } from "node:fs";
import { createServer } from "node:http";
import { join } from "node:path";
import { test } from "node:test";
import { makeFolder, openStudio, paths } from "./browser.mjs";

test("a page from another origin reads nothing, writes nothing and cannot frame the studio", async () => {
  const folder = makeFolder("kidney.json"), studio = await openStudio(folder);
  const { origin, hash } = new URL(studio.address), token = new URLSearchParams(hash.slice(1)).get("token");
  const protocol = /`(ctpm\.studio\.\d+)`/.exec(readFileSync(join(paths.source, "studio", "server", "PROTOCOL.md"), "utf8"))[1];
  const other = createServer((_, answer) => answer.setHeader("Content-Type", "text/html").end("<!doctype html><title>other</title>"));
  await new Promise((resolve) => other.listen(0, "127.0.0.1", resolve));
  const page = await studio.page.context().newPage();
  await page.goto(`http://127.0.0.1:${other.address().port}/`);
  const did = await page.evaluate(async ([origin, token, protocol]) => {
    const outcome = (promise) => promise.then((value) => `let in: ${value}`, () => "refused");
    const json = { "Content-Type": "application/json", Authorization: `Bearer ${token}` }, body = JSON.stringify({ id: 1, call: "folder.list", params: {} });
    const socket = outcome(new Promise((resolve, reject) => {
      const made = new WebSocket(`${origin.replace("http", "ws")}/socket`, [protocol, `token.${token}`]);
      made.onopen = resolve, made.onerror = reject;
    }));
    const frame = document.createElement("iframe");
    const framed = new Promise((resolve) => (frame.onload = resolve)); // refused or not
    frame.src = `${origin}/`, document.body.append(frame);
    await framed;
    return {
      call: await outcome(fetch(`${origin}/call`, { method: "POST", headers: json, body }).then((answer) => answer.text())),
      "call as a form would": await outcome(fetch(`${origin}/call`, { method: "POST", headers: { "Content-Type": "text/plain" }, body }).then((answer) => answer.text())),
      upload: await outcome(fetch(`${origin}/upload/evil.stl`, { method: "PUT", headers: { Authorization: `Bearer ${token}` }, body: "x" }).then((answer) => answer.text())),
      "blind upload": await outcome(fetch(`${origin}/upload/evil.stl`, { method: "PUT", body: "x" }).then((answer) => answer.text())),
      page: await outcome(fetch(`${origin}/`).then((answer) => answer.text())),
      socket: await socket,
    };
  }, [origin, token, protocol]);
  for (const [what, outcome] of Object.entries(did)) assert.equal(outcome, "refused", what);
  assert.equal(await page.frameLocator("iframe").locator("header nav").count(), 0, "the studio in a frame");
  assert.ok(!existsSync(join(folder, "evil.stl")));
  await page.close();
  // The studio's own page goes on.
  assert.ok((await studio.call("folder.list", {})).scenes.some(({ path }) => path === "kidney.json"));
  assert.deepEqual(studio.complaints, []);
  assert.equal(await studio.close(), 0);
  other.close();
  rmSync(folder, { recursive: true });
});
