#include "engine/scenes/blank_strands.hpp"

namespace yuragi::scenes {

pose::StrandSkeleton blank_strands(std::size_t strands, std::size_t links) {
  pose::StrandSkeleton skeleton;
  skeleton.strand_count = strands;
  skeleton.links_per_strand = links;
  for (auto* zeros : {&skeleton.root_x_m, &skeleton.root_y_m, &skeleton.root_z_m, &skeleton.rest_x, &skeleton.rest_z,
                      &skeleton.curl_y, &skeleton.curl_z, &skeleton.rest_curl_rad, &skeleton.link_length_m}) {
    zeros->assign(skeleton.padded_count(), 0.0F);
  }
  skeleton.rest_y.assign(skeleton.padded_count(), 1.0F);
  skeleton.curl_x.assign(skeleton.padded_count(), 1.0F);
  return skeleton;
}

}  // namespace yuragi::scenes
