import "./app.css";
import { App } from "./app.ts";
import { connect } from "./core/connection.ts";
import { Store } from "./core/store.ts";

const host = document.getElementById("app");
if (host) {
  const store = new Store();
  // The address ends in the token and a slash; everything else is relative to it.
  const address = new URL("./", window.location.href);
  new App(store, host, address);
  connect(store, address);
}
