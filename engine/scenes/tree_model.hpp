#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "engine/pose/skeleton.hpp"

namespace yuragi::scenes {

/// How a generation of branches grows out of the one before. Of pairs of numbers the first holds at the foot of the
/// parent, the second at its tip, linear between.
struct BranchHabit {
  double first_at = 0.0;                    ///< the lowest grows at this part of the parent's length
  std::array<double, 2> angle_deg = {};     ///< from the parent's own direction
  std::array<double, 2> length_share = {};  ///< of the tree's height
  /// How far it curls up to the light from foot to tip; below 0: outward and down, by its weight.
  double lift_deg = 0.0;
  /// Every second one is a leader; the others, which fill the crown behind the leaders' tips, have only this part of
  /// its length.
  double minor_share = 1.0;
  /// They grow in groups of about this size, unequal whorls, with bare wood between; 1: evenly along the parent.
  std::size_t whorl = 1;
};

/// The common properties of trees of a species.
struct TreeHabit {
  double height_m = 8.0;     ///< about that of the crown's top
  double trunk_share = 0.5;  ///< the trunk's length, as a part of the height
  BranchHabit limb;          ///< on the trunk
  BranchHabit twig;          ///< on the limbs
  double leaf_angle_deg = 55.0;
  double leaf_length_m = 0.1;
  double leaf_width_share = 0.5;  ///< of the leaf's length
  double leaf_droop_deg = 40.0;   ///< from petiole to tip
  double leafless_share = 0.1;    ///< of a twig, from its foot: leaves grow at its end, where there is light
};

/// Parameters of a tree. At least one of each.
struct TreeSpec {
  TreeHabit habit;
  std::size_t limbs = 15;
  std::size_t twigs = 240;
  std::size_t leaves = 10000;
  std::size_t branch_links = 256;  ///< of trunk, limbs and twigs
  std::size_t leaf_links = 4;
  double size = 1.0;  ///< all lengths are multiplied by this
  std::uint64_t seed = 0;
};

/// The levels of the skeleton that make_tree() grows, in this order.
enum TreePart : std::size_t { kTrunk, kLimbs, kTwigs, kLeaves, kTreePartCount };

/// Grows a tree by rule and seed, its foot at the world's origin: a trunk, limbs on it, twigs on the limbs, and leaves
/// on the twigs in sprays of 16 that are turned as one (`is_turned_by_block`). Limbs and twigs grow in whorls, so that
/// leaves hang in clumps with gaps between. Each is a golden angle around its parent from the one below (phyllotaxis:
/// Vogel 1979, "A better way to construct the sunflower head"), leaves it at the habit's angle, and curls to the light
/// or droops; lengths and angles differ at random. At its beginning a branch's section is the sum of its children's
/// (the pipe model: Shinozaki and others 1964, "A quantitative analysis of plant form"). Deterministic by seed.
/// Allocates; may throw std::bad_alloc. Thread-safe: yes. Realtime-safe: no.
pose::TreeSkeleton make_tree(const TreeSpec& spec);

/// The positions of the other trees of a grove of `trees` in total around one at the world's origin: evenly over a disc
/// (sunflower: Vogel 1979), shifted at random, turned by quarters, 0.8 to 1.15 times as large. Deterministic by seed.
/// May throw std::bad_alloc. Thread-safe: yes. Realtime-safe: no.
pose::TreeCopies grove_of(std::size_t trees, double radius_m, std::uint64_t seed);

/// The levers of a joint for the bends of each level: if no bend of level l changes by more than d[l] (as a vector,
/// rad), no joint moves farther than the sum of lever[l] d[l], metres.
///
/// Proof: a turn by a vector of angles changes by no more than that vector (the derivative of the exponential map
/// shortens), and each link of a joint's path from the ground is turned by i/n of the bend of each strand on that path
/// that is at or before it. Missing levels have 0. The tree has valid parents (TreeKinematicsJob). Thread-safe: yes.
std::array<double, pose::kMaxTreeLevels> tree_levers_m(const pose::TreeSkeleton& tree);

}  // namespace yuragi::scenes
