// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gige_camera/camera_description.h"

#include <initializer_list>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "tests/support/gige_camera/camera_registers.h"

namespace alidade::test {
namespace {

using Choices = std::vector<std::pair<std::string_view, std::uint32_t>>;

// Collects the features and, per category, their names.
class Description {
 public:
  void category(std::string_view name) {
    close_category();
    categories_.emplace_back(name);
    open_ = fmt::format("<Category Name=\"{}\" NameSpace=\"Standard\">\n", name);
  }

  void text(std::string_view name, std::uint32_t at, int length) {
    feature(name, fmt::format("<StringReg Name=\"{}\" NameSpace=\"Standard\"><Address>0x{:x}</Address><Length>{}"
                              "</Length><AccessMode>RO</AccessMode><pPort>Device</pPort></StringReg>\n",
                              name, at, length));
  }

  void integer(std::string_view name, std::uint32_t at, std::string_view bounds, std::string_view access = "RW") {
    const std::string word = integer_register(name, at, access);
    feature(name, fmt::format("<Integer Name=\"{0}\" NameSpace=\"Standard\"><pValue>{0}Register</pValue>{1}"
                              "</Integer>\n{2}",
                              name, bounds, word));
  }

  void real(std::string_view name, std::uint32_t at, std::pair<double, double> bounds, std::string_view unit) {
    feature(name, fmt::format("<Float Name=\"{0}\" NameSpace=\"Standard\"><pValue>{0}Register</pValue><Min>{1}</Min>"
                              "<Max>{2}</Max><Unit>{3}</Unit></Float>\n<FloatReg Name=\"{0}Register\">"
                              "<Address>0x{4:x}</Address><Length>8</Length><AccessMode>RW</AccessMode>"
                              "<pPort>Device</pPort><Endianess>BigEndian</Endianess></FloatReg>\n",
                              name, bounds.first, bounds.second, unit, at));
  }

  void choice(std::string_view name, std::uint32_t at, const Choices& choices) {
    std::string entries;
    for (const auto& [entry, value] : choices) {
      entries +=
          fmt::format("<EnumEntry Name=\"{}\" NameSpace=\"Standard\"><Value>{}</Value></EnumEntry>", entry, value);
    }
    const std::string word = integer_register(name, at, "RW");
    feature(name, fmt::format("<Enumeration Name=\"{0}\" NameSpace=\"Standard\">{1}<pValue>{0}Register</pValue>"
                              "</Enumeration>\n{2}",
                              name, entries, word));
  }

  void boolean(std::string_view name, std::uint32_t at) {
    const std::string word = integer_register(name, at, "RW");
    feature(name, fmt::format("<Boolean Name=\"{0}\" NameSpace=\"Standard\"><pValue>{0}Register</pValue>"
                              "<OnValue>1</OnValue><OffValue>0</OffValue></Boolean>\n{1}",
                              name, word));
  }

  void command(std::string_view name, std::uint32_t at, std::uint32_t value = 1) {
    const std::string word = integer_register(name, at, "WO");
    feature(name, fmt::format("<Command Name=\"{0}\" NameSpace=\"Standard\"><pValue>{0}Register</pValue>"
                              "<CommandValue>{1}</CommandValue></Command>\n{2}",
                              name, value, word));
  }

  // As it stands in the description.
  void verbatim(std::string_view name, std::string_view text) { feature(name, std::string(text)); }

  std::string finish() {
    close_category();
    std::string root = "<Category Name=\"Root\" NameSpace=\"Standard\">\n";
    for (const std::string& name : categories_) root += fmt::format("<pFeature>{}</pFeature>\n", name);
    return root + "</Category>\n" + text_;
  }

 private:
  static std::string integer_register(std::string_view name, std::uint32_t at, std::string_view access) {
    return fmt::format(
        "<IntReg Name=\"{}Register\"><Address>0x{:x}</Address><Length>4</Length><AccessMode>{}"
        "</AccessMode><pPort>Device</pPort><Sign>Unsigned</Sign><Endianess>BigEndian</Endianess>"
        "</IntReg>\n",
        name, at, access);
  }

  void feature(std::string_view name, const std::string& text) {
    open_ += fmt::format("<pFeature>{}</pFeature>\n", name);
    text_ += text;
  }

  void close_category() {
    if (!open_.empty()) text_ += open_ + "</Category>\n";
    open_.clear();
  }

  std::string text_;
  std::string open_;
  std::vector<std::string> categories_;
};

constexpr std::string_view kHead = R"(<?xml version="1.0" encoding="utf-8"?>
<RegisterDescription ModelName="TestCamera" VendorName="Alidade" StandardNameSpace="GEV" SchemaMajorVersion="1"
 SchemaMinorVersion="1" SchemaSubMinorVersion="0" MajorVersion="1" MinorVersion="0" SubMinorVersion="0"
 ToolTip="test camera" ProductGuid="0" VersionGuid="0" xmlns="http://www.genicam.org/GenApi/Version_1_1"
 xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">
)";

constexpr std::string_view kFireTestPacket =
    "<Command Name=\"GevSCPSFireTestPacket\" NameSpace=\"Standard\"><pValue>FireTestPacketRegister</pValue>"
    "<CommandValue>1</CommandValue></Command>\n<MaskedIntReg Name=\"FireTestPacketRegister\"><Address>0xd04</Address>"
    "<Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort><Bit>0</Bit><Endianess>BigEndian</Endianess>"
    "</MaskedIntReg>\n";

std::string packet_size_feature() {
  return fmt::format(
      "<Integer Name=\"GevSCPSPacketSize\" NameSpace=\"Standard\"><pValue>PacketSizeRegister</pValue><Min>{}</Min>"
      "<Max>{}</Max><Inc>4</Inc></Integer>\n<MaskedIntReg Name=\"PacketSizeRegister\"><Address>0xd04</Address>"
      "<Length>4</Length><AccessMode>RW</AccessMode><pPort>Device</pPort><LSB>31</LSB><MSB>16</MSB>"
      "<Sign>Unsigned</Sign><Endianess>BigEndian</Endianess></MaskedIntReg>\n",
      kLeastPacketSize, kMostPacketSize);
}

void describe_image(Description& description, cv::Size sensor) {
  description.category("ImageFormatControl");
  description.integer("SensorWidth", address::kSensorWidth, "", "RO");
  description.integer("SensorHeight", address::kSensorHeight, "", "RO");
  const auto bounds = [](int least, int most) {
    return fmt::format("<Min>{}</Min><Max>{}</Max><Inc>1</Inc>", least, most);
  };
  description.integer("Width", address::kWidth, bounds(1, sensor.width));
  description.integer("Height", address::kHeight, bounds(1, sensor.height));
  description.integer("OffsetX", address::kOffsetX, bounds(0, sensor.width - 1));
  description.integer("OffsetY", address::kOffsetY, bounds(0, sensor.height - 1));
  Choices formats;
  for (const PayloadFormat& format : payload_formats()) formats.emplace_back(format.name, format.number);
  description.choice("PixelFormat", address::kPixelFormat, formats);
}

void describe_acquisition(Description& description) {
  description.category("AcquisitionControl");
  description.choice("AcquisitionMode", address::kAcquisitionMode, {{"Continuous", 0}, {"SingleFrame", kSingleFrame}});
  description.command("AcquisitionStart", address::kAcquisitionStart);
  description.command("AcquisitionStop", address::kAcquisitionStop);
  description.boolean("AcquisitionFrameRateEnable", address::kFrameRateEnable);
  description.real("AcquisitionFrameRate", address::kFrameRate, {kLeastFps, kMostFps}, "Hz");
  description.real("ExposureTime", address::kExposureTime, {kLeastExposureUs, kMostExposureUs}, "us");
  description.choice("ExposureAuto", address::kExposureAuto, {{"Off", kAutoOff}, {"Continuous", kAutoContinuous}});
  description.choice("TriggerSelector", address::kTriggerSelector, {{"FrameStart", 0}});
  description.choice("TriggerMode", address::kTriggerMode, {{"Off", 0}, {"On", 1}});
  description.choice("TriggerSource", address::kTriggerSource,
                     {{"Line0", kTriggerSourceLine0}, {"Software", kTriggerSourceSoftware}});
  description.choice("TriggerActivation", address::kTriggerActivation, {{"RisingEdge", 0}});
  description.command("TriggerSoftware", address::kTriggerSoftware);
}

}  // namespace

std::string camera_description(cv::Size sensor) {
  Description description;
  description.category("DeviceControl");
  description.text("DeviceVendorName", 0x48, 32);
  description.text("DeviceModelName", 0x68, 32);
  description.text("DeviceVersion", 0x88, 32);
  description.text("DeviceID", 0xd8, 16);
  description.text("DeviceSerialNumber", 0xd8, 16);
  describe_image(description, sensor);
  describe_acquisition(description);
  description.category("AnalogControl");
  description.real("Gain", address::kGain, {0, kMostGainDb}, "dB");
  description.choice("GainAuto", address::kGainAuto, {{"Off", kAutoOff}, {"Continuous", kAutoContinuous}});
  description.category("TransportLayerControl");
  description.integer("PayloadSize", address::kPayloadSize, "", "RO");
  description.verbatim("GevSCPSPacketSize", packet_size_feature());
  description.verbatim("GevSCPSFireTestPacket", kFireTestPacket);
  description.command("GevTimestampControlLatch", address::kTimestampControl, 2);
  return std::string(kHead) + description.finish() +
         "<Integer Name=\"TLParamsLocked\"><Visibility>Invisible</Visibility><Value>0</Value><Min>0</Min><Max>1</Max>"
         "</Integer>\n<Port Name=\"Device\" NameSpace=\"Standard\"/>\n</RegisterDescription>\n";
}

}  // namespace alidade::test
