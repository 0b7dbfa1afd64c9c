// Messages, such as refusals of the server, until they are dismissed.
import { dismiss } from "../actions";
import * as state from "../state";
import { Icon } from "./icons";
import { said } from "./words";

export function Messages() {
  return (
    <div class="messages" aria-live="polite">
      {!state.connected.value && (
        <div class="message error" role="alert">
          {state.locked.value ? (
            <p>
              {state.wasConnected.value
                ? "The server was restarted and has a new link. "
                : "The link of this page is incomplete, or from an earlier start of the server. "}
              Open the link that <code>mansard serve</code> printed last. Saved edits are safe.
            </p>
          ) : (
            <p>
              The server does not answer. Start <code>mansard serve</code> again with the same project, and open the link
              that it prints. Saved edits are safe.
            </p>
          )}
        </div>
      )}
      {state.messages.value.map((m) => (
        <div key={m.code + m.message} class={`message ${m.severity}`}>
          <p>
            {said(m)} {m.subject && <span class="quiet">({m.subject})</span>} <code>{m.code}</code>
          </p>
          <button type="button" class="plain" aria-label="Dismiss" onClick={() => dismiss(m)}>
            <Icon name="close" />
          </button>
        </div>
      ))}
    </div>
  );
}
