// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace surf::io {

/// An array of a VTK file: numbers, or the texts that VTK stores as characters ended by 0.
struct VtkArray {
  std::string name;
  std::size_t components = 1;
  std::vector<double> values;      ///< whole numbers are exact up to 2^53
  std::vector<std::string> texts;  ///< for an array of type String, which has no values
  bool is_text = false;

  std::size_t tuples() const { return is_text ? texts.size() : values.size() / components; }
};

/// Reads VTK's XML files (VTK File Formats, kitware.com): text, base64 or appended (raw or base64)
/// data, plain or compressed with zlib, in either byte order. Everything in the file is checked
/// before it is used. Failures are FileErrors, or Unsupported for other compressors.
class VtkXml {
 public:
  /// An element of the file. A missing attribute is empty or the fallback.
  class Element {
   public:
    std::vector<Element> children(const char* name) const;
    std::optional<Element> child(const char* name) const;
    std::string attribute(const char* name) const;
    /// The text in the element, without blanks around it.
    std::string text() const;
    /// A whole number from 0 to 2^53.
    std::uint64_t count(const char* name) const;
    /// The numbers in an attribute, as many as the fallback has.
    std::vector<double> numbers(const char* name, const std::vector<double>& fallback) const;

    /// All arrays directly below, in order.
    std::vector<VtkArray> arrays() const;
    /// The first array of this name, or of any name if it is empty.
    std::optional<VtkArray> array(std::string_view name) const;

    [[noreturn]] void fail(const std::string& reason) const;

   private:
    friend class VtkXml;
    struct Node;
    Element(const VtkXml& xml, std::shared_ptr<const Node> node)
        : xml_(&xml), node_(std::move(node)) {}

    // For the element of an array.
    VtkArray decoded() const;
    std::vector<double> values(const std::string& type) const;

    const VtkXml* xml_;
    std::shared_ptr<const Node> node_;
  };

  /// `type`: "PolyData", "ImageData" or "vtkMultiBlockDataSet". `content` must outlive this object.
  VtkXml(const std::string& file, std::string_view content, const std::string& type);
  ~VtkXml();

  /// The element of that type, below VTKFile.
  Element data() const;

  [[noreturn]] void fail(const std::string& place, const std::string& reason) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace surf::io
