// What the server refused or what else should be known, until dismissed.
import { dismiss } from "../actions";
import * as state from "../state";
import { Icon } from "./icons";

export function Messages() {
  return (
    <div class="messages" aria-live="polite">
      {!state.connected.value && (
        <div class="message error" role="alert">
          {state.locked.value ? (
            <p>
              The server was started again and gave out a new link: open the one that <code>mansard serve</code> printed
              last. What was saved is safe.
            </p>
          ) : (
            <p>
              The server does not answer. What was saved is safe. Start <code>mansard serve</code> again with the same
              project, and open the link it prints.
            </p>
          )}
        </div>
      )}
      {state.messages.value.map((m) => (
        <div key={m.code + m.message} class={`message ${m.severity}`}>
          <p>
            {m.message} {m.subject && <span class="quiet">({m.subject})</span>} <code>{m.code}</code>
          </p>
          <button type="button" class="plain" aria-label="Dismiss" onClick={() => dismiss(m)}>
            <Icon name="close" />
          </button>
        </div>
      ))}
    </div>
  );
}
