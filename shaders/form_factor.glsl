// SPDX-License-Identifier: MIT
// Form factors from a point with a unit normal, nothing between. Read by GLSL and C++.
#pragma once

/// To a small flat source of any shape whose centre lies at `way` from the point: the disc of the
/// same area, which stays bounded as the distance falls. [Wallace, Elmquist & Haines 1989]
LANTERN_SHARED float point_to_disc(vec3 way, vec3 normal, vec3 source_normal, float area) {
  const float pi = 3.14159265358979f;
  float square = dot(way, way);
  float cosines = max(dot(normal, way), 0.0f) * max(-dot(source_normal, way), 0.0f);
  return cosines * area / (square * (pi * square + area));
}

/// One edge's part of Lambert's sum: its angle, along the normal of the plane through the point.
LANTERN_SHARED float edge_part(vec3 a, vec3 b, vec3 normal) {
  vec3 c = cross(a, b);
  float s = length(c);
  return s > 0.0f ? atan(s, dot(a, b)) * dot(normal, c) / s : 0.0f;
}

/// To a triangle whose corners, relative to the point, run counter-clockwise seen from its front:
/// 0 for points behind it. What lies below the point's horizon is cut off. [Lambert 1760, as a sum
/// over edges: Baum, Rushmeier & Winget 1989, equation 5]
LANTERN_SHARED float point_to_triangle(vec3 a, vec3 b, vec3 c, vec3 normal) {
  const float pi = 3.14159265358979f;
  float ha = dot(normal, a);
  float hb = dot(normal, b);
  float hc = dot(normal, c);
  if (max(ha, max(hb, hc)) <= 0.0f) return 0.0f;
  if (min(ha, min(hb, hc)) >= 0.0f) {
    float whole = edge_part(a, b, normal) + edge_part(b, c, normal) + edge_part(c, a, normal);
    return max(-whole / (2.0f * pi), 0.0f);
  }
  // Turned so that either a alone is above the horizon, or a alone below it.
  bool one_above = (ha > 0.0f ? 1 : 0) + (hb > 0.0f ? 1 : 0) + (hc > 0.0f ? 1 : 0) == 1;
  if ((hb > 0.0f) == one_above && (ha > 0.0f) != one_above && (hc > 0.0f) != one_above) {
    vec3 p = a;
    a = b;
    b = c;
    c = p;
    float h = ha;
    ha = hb;
    hb = hc;
    hc = h;
  } else if ((hc > 0.0f) == one_above && (ha > 0.0f) != one_above && (hb > 0.0f) != one_above) {
    vec3 p = a;
    a = c;
    c = b;
    b = p;
    float h = ha;
    ha = hc;
    hc = hb;
    hb = h;
  }
  vec3 ab = a + (b - a) * (ha / (ha - hb));
  vec3 ac = a + (c - a) * (ha / (ha - hc));
  float sum;
  if (one_above) {
    sum = edge_part(a, ab, normal) + edge_part(ab, ac, normal) + edge_part(ac, a, normal);
  } else {
    sum = edge_part(ab, b, normal) + edge_part(b, c, normal) + edge_part(c, ac, normal) +
          edge_part(ac, ab, normal);
  }
  return max(-sum / (2.0f * pi), 0.0f);
}

/// The share of a triangle's area that is above the horizon, of its corners' heights.
LANTERN_SHARED float share_above(float ha, float hb, float hc) {
  float low = min(ha, min(hb, hc));
  float high = max(ha, max(hb, hc));
  if (low >= 0.0f) return 1.0f;
  if (high <= 0.0f) return 0.0f;
  float middle = max(min(ha, hb), min(max(ha, hb), hc));
  // The corner that is alone on its side cuts off a triangle like the whole.
  if (middle <= 0.0f) return high * high / ((high - middle) * (high - low));
  return 1.0f - low * low / ((low - middle) * (low - high));
}
