// A browser of another machine, behind a proxy that ends TLS: proxy_test.mjs PROGRAM SOURCE PACKAGES SESSIONS PICTURES
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readFileSync, rmSync } from "node:fs";
import { request } from "node:http";
import { createServer } from "node:https";
import { connect, createServer as createPlain } from "node:net";
import { join } from "node:path";
import { test } from "node:test";
import { makeFolder, openStudio } from "./browser.mjs";

function listen(server) {
  return new Promise((resolve) => server.listen(0, "127.0.0.1", () => resolve(server.address().port)));
}

/** A proxy that ends TLS and passes everything on to a port of this machine, headers as they came. */
function makeProxy(folder, port) {
  const [key, cert] = ["key.pem", "cert.pem"].map((name) => join(folder, name));
  const made = spawnSync("openssl", ["req", "-x509", "-newkey", "rsa:2048", "-nodes", "-keyout", key, "-out", cert, "-days", "1", "-subj", "/CN=localhost"]);
  assert.equal(made.status, 0, String(made.stderr));
  const proxy = createServer({ key: readFileSync(key), cert: readFileSync(cert) }, (from, to) => {
    const on = request({ port, method: from.method, path: from.url, headers: from.headers }, (answer) => {
      to.writeHead(answer.statusCode, answer.headers);
      answer.pipe(to);
    });
    from.pipe(on);
  });
  proxy.on("upgrade", (from, socket, head) => {
    const on = connect(port, "127.0.0.1", () => {
      const lines = from.rawHeaders.map((word, i) => (i % 2 ? `${word}\r\n` : `${word}: `)).join("");
      on.write(`${from.method} ${from.url} HTTP/1.1\r\n${lines}\r\n`);
      on.write(head);
      on.pipe(socket).pipe(on);
    });
    for (const end of [on, socket]) end.on("error", () => (on.destroy(), socket.destroy()));
  });
  return proxy;
}

test("a page that came through the proxy shows a session", async () => {
  const folder = makeFolder("liver-press-expert.ctpm");
  const free = createPlain(), port = await listen(free);
  await new Promise((resolve) => free.close(resolve));
  const proxy = makeProxy(folder, port), outside = `https://localhost:${await listen(proxy)}`;
  const studio = await openStudio(folder, port, "--behind", outside);
  assert.ok(studio.address.startsWith(`${outside}/#token=`));
  await studio.page.click("header nav button:has-text('Review')");
  await studio.page.click(".list button:has-text('liver-press-expert')");
  await studio.page.waitForFunction(() => [...document.querySelectorAll(".readings div")].some((d) => /replayed after\d+ ms/.test(d.textContent)));
  assert.deepEqual(studio.complaints, []);
  assert.equal(await studio.close(), 0);
  proxy.closeAllConnections(), proxy.close();
  rmSync(folder, { recursive: true });
});
