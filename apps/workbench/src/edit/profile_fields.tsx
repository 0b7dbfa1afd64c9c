import type { Plan, ProfilePoint } from "../api/types";
import { Icon } from "../panels/icons";
import { NumberField } from "./fields";
import { metres } from "./numbers";
import {
  degreesOf,
  gutterOf,
  lastRoof,
  pitchOf,
  slopeOfDegrees,
  slopeTo,
  withSlope,
  type Profile,
} from "./profile";

/** The number fields of a profile and its part. */
export function ProfileFields(props: {
  plan: Plan;
  part: string;
  profile: Profile;
  /** Of a corner edge: degrees clockwise from north, and the wall that it is nearest to. */
  direction: number | null;
  beside: { at: { edge: number }; degrees: number } | null;
  onDirection(bearing: number): void;
  who: string; // description of these edges
  point: number | null;
  share: number;
  onShare(share: number): void;
  several: number; // selected parts that values go to
  /** Changes of the part, and of its profiles: for each that has the values which are changed. */
  onPlan(what: string, change: (plan: Plan) => Plan): void;
  onProfile(what: string, change: (profile: Profile) => Profile | null): void;
  onMove(i: number, to: ProfilePoint): void;
  onGutter(height: number): void;
  onRemove(i: number): void;
}) {
  const { plan, part, profile, who, share, onPlan, onProfile } = props;
  const i = props.point ?? 0;
  const point = i > 0 ? profile[i] : undefined;
  const slope = point ? slopeTo(profile, i) : null;
  const pitch = pitchOf(profile);
  const turn = (at: number | null, degrees: number) => {
    if (degrees >= 0 && degrees < 90)
      onProfile(`pitch of ${who} to ${degrees.toFixed(1)}°`, (p) => {
        const i = at ?? lastRoof(p);
        return i > 0 && (at === null || p.length === profile.length) ? withSlope(p, i, slopeOfDegrees(degrees)) : null;
      });
  };
  return (
    <div class="edit-fields">
      <label class="edit-share" title="Position of the section along the edge">
        Section at
        <input
          type="range"
          min={0}
          max={1}
          step={0.01}
          value={share}
          aria-valuetext={`${Math.round(share * 100)} % of the edge`}
          onInput={(event) => props.onShare(Number(event.currentTarget.value))}
        />
        <output>{Math.round(share * 100)} %</output>
      </label>
      {props.several > 1 && (
        <span class="edit-several" title="A cap or a base goes to every selected part; a gutter, a pitch or a point to the edges of the others that face the same way, or to all edges with “Apply to all edges”">
          Values go to {props.several} selected parts
        </span>
      )}
      {props.direction !== null && (
        <NumberField
          label="Direction"
          unit="°"
          digits={2}
          value={props.direction}
          title={`Direction of the eaves, clockwise from north. ${props.beside ? `It is ${props.beside.degrees.toFixed(1)}° from edge ${props.beside.at.edge}. ` : ""}It stays between the directions of the two walls`}
          onValue={props.onDirection}
        />
      )}
      <NumberField
        label="Gutter"
        unit="m"
        value={gutterOf(profile)}
        title="Height above the base at which the roof begins. The roof moves along"
        onValue={props.onGutter}
      />
      <NumberField
        label="Pitch"
        unit="°"
        digits={2}
        value={pitch === null ? null : degreesOf(pitch)}
        title="Pitch of the topmost roof segment"
        onValue={(degrees) => turn(null, degrees)}
      />
      <NumberField
        label="Cap"
        unit="m"
        value={plan.cap}
        title="Height above the base at which the part is cut off horizontally"
        onValue={(cap) => onPlan(`cap of ${part} to ${metres(cap)}`, (p) => ({ ...p, cap }))}
      />
      <NumberField
        label="Base"
        unit="m"
        value={plan.base}
        title="Height z of the bottom of the part"
        onValue={(base) => onPlan(`base of ${part} to ${metres(base)}`, (p) => ({ ...p, base }))}
      />
      <span class="edit-point" role="group" aria-label="Selected point">
        <b>{point ? `Point ${i}` : "No point"}</b>
        <NumberField label="Inward" unit="m" value={point?.[0] ?? null} onValue={(v) => props.onMove(i, [v, point![1]])} />
        <NumberField label="Height" unit="m" value={point?.[1] ?? null} onValue={(v) => props.onMove(i, [point![0], v])} />
        <NumberField
          label="Pitch"
          unit="°"
          digits={2}
          title="Pitch of the segment below the point"
          value={slope === null || slope === Infinity ? null : degreesOf(slope)}
          onValue={(degrees) => turn(i, degrees)}
        />
        <button
          type="button"
          title="Remove the point"
          aria-label="Remove the point"
          onClick={() => props.onRemove(i)}
          disabled={!point || profile.length <= 2}
        >
          <Icon name="bin" />
        </button>
      </span>
    </div>
  );
}
