// Houses for the tests.
import type { Plan, Point2 } from "../api/types";
import { together } from "./corner_edges";
import type { Profile } from "./profile";

export const roof: Profile = [
  [0, 0],
  [0, 6],
  [4, 10],
];
export const gable: Profile = [
  [0, 0],
  [0, 10],
];

/** 10 by 8 m from the origin: eaves at 6 m along edges 0 and 2, gables at 1 and 3.
 *
 *  3 +----2----+ 2
 *    3         1
 *  0 +----0----+ 1
 */
export const house = (): Plan => ({
  base: 1.25,
  cap: 12,
  outer: {
    points: [
      [0, 0],
      [10, 0],
      [10, 8],
      [0, 8],
    ],
    profile_of_edge: [0, 1, 0, 1],
  },
  holes: [],
  profiles: [roof, gable],
});

/** The house with a courtyard of 2 by 2 m in its middle. */
export const courtyardHouse = (): Plan => ({
  ...house(),
  holes: [
    {
      points: [
        [4, 3],
        [4, 5],
        [6, 5],
        [6, 3],
      ],
      profile_of_edge: [1, 1, 1, 1],
    },
  ],
});

export const withCorners = (points: Point2[]): Plan => ({
  ...house(),
  outer: { points, profile_of_edge: points.map((_, i) => i % 2) },
});

/** A gable over an oblique side: the corner edge is number 3, parallel to edge 0.
 *
 *  4 +--.
 *    |    `--. 2
 *  0 +--------+ 1
 */
export const obliqueHouse = (): Plan =>
  together(
    {
      base: 0,
      cap: 20,
      outer: {
        points: [
          [0, 0],
          [20, 0],
          [20, 8],
          [0, 10],
        ],
        profile_of_edge: [0, 1, 1, 1],
      },
      holes: [],
      profiles: [roof, gable],
    },
    [{ ring: 0, corner: 3, along: [-1, 0], profile: 0 }],
  );
